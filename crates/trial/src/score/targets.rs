//! What a diagnosis must reach, and where it does not: METHOD's targets, met by the share itself, not by its interval.

use serde_json::Value;

/// Of a score at this place the number must not be below or above.
struct Target {
    what: &'static str,
    at: &'static str,
    from: f64,
    to: f64,
}

const TARGETS: [Target; 9] = [
    Target { what: "false names on clean data", at: "/clean/false_names_rate/share", from: 0.0, to: 0.02 },
    Target { what: "right when it names", at: "/right_when_named/share", from: 0.95, to: 1.0 },
    Target {
        what: "name and place of one identifiable effect",
        at: "/single/location_ok_rate/share",
        from: 0.9,
        to: 1.0,
    },
    Target {
        what: "truth inside the reported class",
        at: "/single/in_class_rate/share",
        from: 0.95,
        to: 1.0,
    },
    Target {
        what: "unknown physics called unexplained",
        at: "/unknown/called_unknown_rate/share",
        from: 0.9,
        to: 1.0,
    },
    Target {
        what: "unknown physics wrongly named",
        at: "/unknown/wrongly_named_rate/share",
        from: 0.0,
        to: 0.05,
    },
    Target {
        what: "both of two identifiable effects found",
        at: "/pairs/both_found_rate/share",
        from: 0.6,
        to: 1.0,
    },
    Target { what: "95 % intervals that hold the truth", at: "/coverage", from: 0.9, to: 0.98 },
    Target { what: "held-out gain over the oracle's", at: "/gain_over_oracle", from: 0.9, to: f64::INFINITY },
];

/// A sentence for each target that a score misses; what no case speaks about is not missed.
pub fn missed(score: &Value) -> Vec<String> {
    let sentence = |target: &Target| {
        let share = score.pointer(target.at)?.as_f64()?;
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        let wanted = match (target.from, target.to) {
            (from, to) if from > 0.0 && to < 1.0 => format!("{} to {}", percent(from), percent(to)),
            (from, _) if from > 0.0 => format!("at least {}", percent(from)),
            (_, to) => format!("at most {}", percent(to)),
        };
        let is_missed = share < target.from || share > target.to;
        is_missed.then(|| format!("{}: {}, wanted {wanted}", target.what, percent(share)))
    };
    TARGETS.iter().filter_map(sentence).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn what_is_missed_is_said_and_what_nobody_asked_is_not() {
        let score = json!({"clean": {"false_names_rate": {"share": 0.03}}, "coverage": 0.99,
                           "pairs": {"both_found_rate": {"share": null}}, "gain_over_oracle": 0.95});
        assert_eq!(
            missed(&score),
            [
                "false names on clean data: 3.0 %, wanted at most 2.0 %",
                "95 % intervals that hold the truth: 99.0 %, wanted 90.0 % to 98.0 %"
            ]
        );
    }
}
