//! Whether c_rod ranks rods as their accuracy does: sentences and JSON.

use serde_json::{Value, json};

use crate::design::Proxy;
use crate::units::{UM, significant};

/// Errors up to so many times the least are as good as that.
const EQUAL: f64 = 1.05;
/// Coefficients beyond which one order says another, or does not.
const GOOD: f64 = 0.5;

/// Whether no rod is better than another in a mode.
pub fn is_alike(proxy: &Proxy) -> bool {
    proxy.rms[1] <= proxy.rms[0] * EQUAL
}

/// A sentence for each mode.
pub fn sentences(proxies: &[Proxy]) -> Vec<String> {
    let um = |size: f64| significant(size / UM, 3);
    let r = |r: f64| format!("{r:.2}").replace('-', "−");
    let sentence = |proxy: &Proxy| {
        let [low, high] = proxy.rms;
        let what = match (is_alike(proxy), proxy.interval) {
            (true, _) => "no rod is better than another by 5 %, so that c_rod need not be looked at",
            (_, [from, _]) if from > GOOD => "c_rod is a good proxy",
            (_, [_, to]) if to < GOOD => "c_rod is no proxy",
            _ => "these rods do not tell whether c_rod is a proxy",
        };
        format!(
            "Mode {}: {what}. Error {} to {} µm; it follows c_rod with a rank correlation of {} ({} to {}).",
            proxy.mode.name(),
            um(low),
            um(high),
            r(proxy.r),
            r(proxy.interval[0]),
            r(proxy.interval[1])
        )
    };
    proxies.iter().map(sentence).collect()
}

/// One object for each mode.
pub fn json(proxies: &[Proxy]) -> Value {
    let one = |proxy: &Proxy| {
        json!({
            "mode": proxy.mode.name(),
            "spearman": proxy.r,
            "interval": proxy.interval,
            "rms_um": proxy.rms.map(|rms| rms / UM),
        })
    };
    proxies.iter().map(one).collect()
}
