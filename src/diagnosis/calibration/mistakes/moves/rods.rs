//! The rod that its file means where L1 and L2 are exchanged.

use super::super::super::effects::mistakes::SWAP_MISTAKE;
use super::super::draft::DraftChange;
use super::{List, UNUSUAL};
use crate::calibration::campaign::Campaign;
use crate::inference::Key;
use crate::rod::Rod;

/// The rod with the one pipe as long as the other; `None` where that is no rod, the same one, or
/// one whose tip is farther from the one that the campaign gives.
pub fn exchanged(campaign: &Campaign) -> Option<Rod> {
    let rod = campaign.rod.as_ref().filter(|rod| rod.l1 != rod.l2)?;
    let other = Rod { l1: rod.l2, l2: rod.l1, ..rod.clone() }.checked().ok()?;
    let off = |rod: &Rod| (rod.tip() - campaign.tool).norm();
    (!campaign.tool_is_given || off(&other) < off(rod)).then_some(other)
}

impl List<'_> {
    /// The body with that rod.
    pub fn exchanged_pipes(&mut self, body: Option<(usize, &Rod)>) {
        let Some((body, rod)) = body else { return };
        let tip = (!self.campaign.tool_is_given).then(|| rod.tip());
        let (change, place) = (DraftChange::Body(body, tip), Key::new("l1_mm and l2_mm"));
        let cure = "Exchange l1_mm and l2_mm of the rod's file";
        let why = "the poses are those of a rod with the one pipe as long as the other";
        self.add(&SWAP_MISTAKE, place, change, cure, why).log_prior = UNUSUAL;
    }
}
