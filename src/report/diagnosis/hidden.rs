//! Effects that the parameters of the base model hide.

use super::subject::Subject;
use crate::inference::Effect;

/// Places by effect, without those that are seen in another form.
pub fn hidden(subject: &Subject) -> Vec<(&'static Effect, Vec<String>)> {
    let mut hidden: Vec<(&'static Effect, Vec<String>)> = Vec::new();
    for absorbed in subject.absorbed {
        let place = absorbed.location.place();
        let is_seen = subject
            .candidates
            .iter()
            .any(|candidate| candidate.effect == absorbed.effect && candidate.location.place() == place);
        if is_seen {
            continue;
        }
        let place = place.to_string();
        match hidden.iter_mut().find(|(effect, _)| *effect == absorbed.effect) {
            Some((_, places)) if places.contains(&place) => {}
            Some((_, places)) => places.push(place),
            None => hidden.push((absorbed.effect, vec![place])),
        }
    }
    hidden
}
