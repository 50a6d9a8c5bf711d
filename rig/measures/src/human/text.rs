//! The measures in words.

use kernel::time::{TICK_HZ, Tick};

use super::{HazardTimes, Measures, Response, ScreenAge, Spread, Tally};
use crate::criticality::{Criticality, Extreme, Extremes, Sample};

/// The measures of a recording as names and values.
pub fn lines(measures: &Measures) -> Vec<(&'static str, String)> {
    let hazards = measures.hazards.iter().map(|hazard| ("hazard", hazard.words()));
    let seen = measures.seen.iter().map(|press| ("seen", format!("{}: {} driver", at(press.tick), press.seat)));
    let age = measures.mask_age.as_ref().map(|age| ("mask age", age.words()));
    let (rates, seconds) = (&measures.steering_reversals_per_min, measures.steering_s);
    let reversals = format!(
        "semantic driver {:.1}, safety driver {:.1} a minute, over {seconds:.1} s",
        rates.semantic, rates.safety
    );
    hazards.chain(seen).chain(age).chain([("reversals", reversals)]).collect()
}

fn at(tick: Tick) -> String {
    format!("tick {tick} ({:.2} s)", tick as f64 / f64::from(TICK_HZ))
}

impl Extremes {
    /// As names and values.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let line = |name, unit, extreme: &Option<Extreme>| {
            let Extreme { value, tick, with } = extreme.as_ref()?;
            Some((name, format!("{value:.2} {unit} at {}, {with}", at(*tick))))
        };
        let lines = [
            line("least TTC", "s", &self.min_ttc_s),
            line("least PrET", "s", &self.min_pret_s),
            line("PET", "s", &self.pet_s),
            line("braking", "m/s^2 required", &self.max_required_deceleration_mps2),
        ];
        lines.into_iter().flatten().collect()
    }
}

impl Criticality {
    /// As names and values.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let predicted = |sample: &Sample| Some((sample.tick, sample.encroachment.clone()?));
        let predicted: Vec<_> = self.samples.iter().filter_map(predicted).collect();
        let (n, of) = (predicted.len(), self.samples.len());
        let encroachment = predicted.last().map_or_else(
            || "none predicted".into(),
            |(tick, what)| format!("predicted in {n} of {of} samples, last at {}: {what}", at(*tick)),
        );
        std::iter::once(("encroachment", encroachment)).chain(self.extremes.lines()).collect()
    }
}

impl HazardTimes {
    /// What it was and what came of it.
    pub fn words(&self) -> String {
        let answers = [("semantic driver", &self.semantic), ("safety driver", &self.safety)];
        let mut parts: Vec<String> = answers.into_iter().flat_map(|(who, response)| response.words(who)).collect();
        parts.extend(self.intervention_ms.map(|ms| format!("takeover after {ms} ms")));
        if parts.is_empty() {
            parts.push("no reaction".into());
        }
        let mistake = self.episode.mistake.as_ref().map_or(String::new(), |mistake| format!("; {}", mistake.words));
        format!("{}, {}{mistake}: {}", at(self.episode.onset), self.episode.what, parts.join(", "))
    }
}

impl Response {
    fn words(&self, who: &str) -> Vec<String> {
        let reaction = self.reaction_ms.zip(self.by).map(|(ms, by)| format!("{who}'s {by} after {ms} ms"));
        let seen = self.seen_ms.map(|ms| format!("seen by the {who} after {ms} ms"));
        seen.into_iter().chain(reaction).collect()
    }
}

impl ScreenAge {
    /// Median, 99th percentile and greatest.
    pub fn words(&self) -> String {
        let mut text = spread_words(&self.ticks, "ticks");
        if let Some(ms) = &self.ms {
            text = format!("{text}; {}", spread_words(ms, "ms"));
        }
        if let Some(ms) = &self.frame_to_screen_ms {
            text = format!("{text}; frame to screen {}", spread_words(ms, "ms"));
        }
        text
    }
}

fn spread_words(spread: &Spread, unit: &str) -> String {
    format!("median {:.0}, p99 {:.0}, max {:.0} {unit}", spread.median, spread.p99, spread.max)
}

impl Tally {
    /// As names and values.
    pub fn lines(&self) -> Vec<(&'static str, String)> {
        let Self { runs, familiarisation_runs, discarded_runs, interventions, labelled, boredom, hazards, .. } = self;
        let practice = match familiarisation_runs {
            0 => String::new(),
            n => format!(", and {n} for familiarisation, which do not count"),
        };
        let discarded = match discarded_runs {
            0 => String::new(),
            n => format!(", and {n} that operators discarded or in which the rig failed"),
        };
        let bored = self.boredom_share.map_or(String::new(), |s| {
            format!("; {boredom} of {labelled} labelled were out of boredom ({:.0} %)", 100.0 * s)
        });
        let times = [
            ("semantic driver's reaction", &self.semantic_reaction_ms),
            ("semantic driver's \"I see it\"", &self.semantic_seen_ms),
            ("safety driver's reaction", &self.safety_reaction_ms),
            ("safety driver's \"I see it\"", &self.safety_seen_ms),
            ("takeover", &self.intervention_ms),
        ];
        let times = times.into_iter().filter_map(|(name, spread)| {
            let Spread { n, median, max, .. } = spread.as_ref()?;
            Some(("hazard to", format!("{name}: median {median:.0} ms, max {max:.0} ms ({n} of {hazards} hazards)")))
        });
        let (km, by_mistakes) = (self.km, self.hazards_by_mistakes);
        let rates = self.hazards_per_km.zip(self.hazards_by_mistakes_per_km);
        let rates = rates.map_or(String::new(), |(all, by)| format!(": {all:.2} a km, {by:.2} by mistakes of others"));
        let head = [
            ("runs", format!("{runs}{practice}{discarded}")),
            ("takeovers", format!("{interventions}{bored}")),
            ("hazards", format!("{hazards}, {by_mistakes} of them by mistakes of others, in {km:.2} km{rates}")),
        ];
        head.into_iter().chain(times).collect()
    }
}
