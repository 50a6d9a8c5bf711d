//! The section `[hazards]` of a scenario's text.

use crate::traffic::{HazardLevel, HazardRates};

use super::fields::ScenarioError;
use super::reader::Section;

/// Takes over what a text says of a level, and of rates that replace those of the level.
pub(super) fn read_hazards(root: &mut Section<'_>, to: &mut HazardRates) -> Result<(), ScenarioError> {
    let levels = HazardLevel::ALL.map(|level| format!("{:?}", level.name())).join(" or ");
    root.section("hazards", &format!("level = {levels}"), |section| {
        if let Some(level) = section.named("level", || levels.clone(), HazardLevel::named)? {
            *to = level.rates();
        }
        let (share, per_h) = (0.0..=1.0, 0.0..=600.0);
        section.number("red_light_runners", share.clone(), &mut to.red_light_runners)?;
        section.number("rolling_stops", share.clone(), &mut to.rolling_stops)?;
        section.number("tailgaters", share, &mut to.tailgaters)?;
        section.number("cut_ins_per_h", per_h.clone(), &mut to.cut_ins_per_h)?;
        section.number("hard_brakings_per_h", per_h.clone(), &mut to.hard_brakings_per_h)?;
        section.number("pull_outs_per_h", per_h, &mut to.pull_outs_per_h)?;
        section.number("doors_per_h", 0.0..=180.0, &mut to.doors_per_h)?;
        section.number("inattention", 0.0..=2.0, &mut to.inattention)
    })
}

/// The section that is read back as these rates. It names no level: that may come to mean others.
pub(super) fn print_hazards(rates: &HazardRates) -> String {
    let HazardRates { red_light_runners, rolling_stops, tailgaters, .. } = rates;
    let HazardRates { cut_ins_per_h, hard_brakings_per_h, pull_outs_per_h, doors_per_h, inattention, .. } = rates;
    format!(
        "[hazards]\nred_light_runners = {red_light_runners:?}\nrolling_stops = {rolling_stops:?}\n\
         tailgaters = {tailgaters:?}\ncut_ins_per_h = {cut_ins_per_h:?}\n\
         hard_brakings_per_h = {hard_brakings_per_h:?}\npull_outs_per_h = {pull_outs_per_h:?}\n\
         doors_per_h = {doors_per_h:?}\ninattention = {inattention:?}\n"
    )
}

#[cfg(test)]
mod tests {
    use crate::scenario::Scenario;
    use crate::traffic::HazardLevel;

    const TEXT: &str = "map = \"field\"\n\n[hazards]\nlevel = \"raised\"\nrolling_stops = 0.25\n";

    #[test]
    fn a_rate_replaces_that_of_the_level() {
        let mut expected = HazardLevel::Raised.rates();
        expected.rolling_stops = 0.25;
        let scenario = Scenario::from_toml(TEXT).expect("a valid text");
        assert_eq!(scenario.hazards, expected);
        assert_eq!(Scenario::from_toml(&scenario.to_toml()), Ok(scenario));
        let bare = Scenario::from_toml("map = \"field\"\n[hazards]\ninattention = 0\n").expect("a valid text");
        let mut expected = HazardLevel::Natural.rates();
        expected.inattention = 0.0;
        assert_eq!(bare.hazards, expected);
    }

    #[test]
    fn every_level_comes_back() {
        for level in HazardLevel::ALL {
            let mut scenario = Scenario::default_for("field", 3);
            scenario.hazards = level.rates();
            assert_eq!(Scenario::from_toml(&scenario.to_toml()), Ok(scenario));
        }
    }

    #[test]
    fn mistakes_are_named_by_line_and_key() {
        let refused = |from: &str, to: &str| Scenario::from_toml(&TEXT.replace(from, to)).expect_err("refused").0;
        let level = refused("raised", "high");
        assert_eq!(level, "line 4: hazards.level is \"high\", expected \"none\" or \"natural\" or \"raised\"");
        let range = refused("= 0.25", "= 1.25");
        assert_eq!(range, "line 5: hazards.rolling_stops is 1.25, expected a number from 0 to 1");
        let name = refused("rolling_stops", "rolling_stop");
        assert!(name.starts_with("line 5: unknown key hazards.rolling_stop, expected one of level, "), "{name}");
    }
}
