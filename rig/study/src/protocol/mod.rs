//! The protocol of a study for a pair of people: what they drive, in which order, who sits where, and what comes between.

mod progress;
mod square;
mod text;

use std::path::{Path, PathBuf};

use anyhow::Context;
use base::failure::Usage;
use base::files::{self, most};
use base::setting::Setting;
use base::toml_text;
use drivers::checkpoint::{CheckpointChoice, check_names};
use kernel::Scenario;
use kernel::rng::{self, Stream};
use replay::Provenance;

use crate::{Pseudonym, Study};
pub use progress::{Ended, Progress, Recorded};
use text::{Condition, Text};
pub use text::{Order, Questions};

/// Which protocol a recording is of, and which of its trials, from 1, in provenance.
const PROTOCOL: &str = "plan";
const TRIAL: &str = "plan_trial";

/// What a pair of people drives.
#[derive(Clone, Debug)]
pub struct Protocol {
    /// Whoever begins as the semantic driver, and the other one.
    pub participants: [Pseudonym; 2],
    /// Nobody is told which checkpoint drives.
    pub is_blind: bool,
    /// A break between the halves, seconds.
    pub break_s: u32,
    /// When both drivers are asked how they are.
    pub questions: Questions,
    /// All that is driven, in order.
    pub trials: Vec<Trial>,
    /// The checkpoints of all trials.
    pub checkpoints: Vec<CheckpointChoice>,
    link: Option<String>,
    seed: u64,
    digest: String,
    path: PathBuf,
}

/// One of the things to be driven.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Where it takes place.
    pub setting: Setting,
    /// What its runs start from, whatever their seeds.
    pub scenario: Scenario,
    /// What the semantic driver sees: which of the protocol's checkpoints.
    pub checkpoint: usize,
    /// Kilometres to drive, over as many runs as that takes; without, one run that comes to its end.
    pub km: Option<f64>,
    /// Both drivers sit where the other one began.
    pub is_swapped: bool,
    /// It is the first after the seats were swapped.
    pub begins_half: bool,
    /// It is the last of its half.
    pub ends_half: bool,
}

impl Protocol {
    /// Reads a file; what is wrong is said in a sentence that names file and key. Files that it names are looked for
    /// beside it.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let usage = |reason: String| Usage(format!("{}: {reason}", path.display()));
        let text: Text = toml_text::read(&files::read_text(path, most::TEXT)?).map_err(usage)?;
        let participants = text.check().map_err(usage)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut checkpoints = Vec::new();
        let conditions = text.conditions.iter().enumerate().map(|(index, condition)| {
            let place = || format!("{}: condition {}", path.display(), index + 1);
            let checkpoint = condition.checkpoint(folder).map_err(|reason| Usage(format!("{}: {reason}", place())))?;
            let known = checkpoints.iter().position(|known| *known == checkpoint);
            let index = known.unwrap_or_else(|| {
                checkpoints.push(checkpoint);
                checkpoints.len() - 1
            });
            trial(condition, folder, index, &place)
        });
        let conditions = conditions.collect::<anyhow::Result<Vec<Trial>>>()?;
        check_names(&checkpoints).map_err(|Usage(reason)| usage(reason))?;
        if text.blind && checkpoints.len() < 2 {
            return Err(usage("blind: expected conditions with two or more checkpoints".into()).into());
        }
        let order = match text.order {
            Order::Square => square::row(conditions.len(), text.row as usize - 1),
            Order::AsWritten => (0..conditions.len()).collect(),
        };
        Ok(Self {
            participants,
            is_blind: text.blind,
            break_s: text.break_s,
            questions: text.questions,
            trials: in_halves(&conditions, &order, text.swap),
            checkpoints,
            link: text.link.clone(),
            seed: text.seed,
            digest: digest(&text)?,
            path: path.to_owned(),
        })
    }

    /// Where it was read from.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Who drives, and what nobody is told, as a study has it.
    pub fn study(&self) -> Study {
        let [semantic, safety] = self.participants.clone();
        let blind = if self.is_blind { self.checkpoints.clone() } else { Vec::new() };
        Study { semantic_name: Some(semantic), safety_name: Some(safety), blind, ..Study::default() }
    }

    /// What a run of a trial starts from, after so many others of the same trial.
    pub fn scenario(&self, trial: usize, earlier: usize) -> Scenario {
        let seed = rng::bits(self.seed, Stream::Scenario, trial as u64 + 1, earlier as u64 + 1) >> 32;
        Scenario { seed, ..self.trials[trial].scenario.clone() }
    }

    /// What the recordings of a trial say about it.
    pub fn provenance(&self, trial: usize) -> Provenance {
        [(PROTOCOL.into(), self.digest.clone()), (TRIAL.into(), (trial + 1).to_string())].into()
    }

    /// Which of the trials a recording is of; a recording of anything else is refused.
    pub fn trial_of(&self, provenance: &Provenance) -> Result<usize, String> {
        let number = provenance.get(TRIAL).and_then(|number| number.parse::<usize>().ok());
        match (provenance.get(PROTOCOL), number) {
            (Some(digest), Some(number)) if *digest == self.digest && (1..=self.trials.len()).contains(&number) => {
                Ok(number - 1)
            }
            (Some(_), _) => Err(format!("is of another plan than {}; expected another --record", self.path.display())),
            (None, _) => Err("was not driven by a plan; expected another --record".into()),
        }
    }

    /// Who drives a half: the semantic driver, and the safety driver.
    pub fn seated(&self, is_swapped: bool) -> [&Pseudonym; 2] {
        let [first, second] = &self.participants;
        if is_swapped { [second, first] } else { [first, second] }
    }

    /// What a trial is, for people to read: place and weather, never the checkpoint.
    pub fn words(&self, trial: usize) -> String {
        let Trial { scenario, km, .. } = &self.trials[trial];
        let km = km.map(|km| format!(", {km} km")).unwrap_or_default();
        format!("trial {} of {}: {}{km}", trial + 1, self.trials.len(), scenario.map)
    }

    /// Where people are to answer questions of somebody else's after a run of a trial; `{participants}`, `{trial}` and
    /// `{run}` in it are filled in.
    pub fn link(&self, trial: usize, run: u32) -> Option<String> {
        let [first, second] = &self.participants;
        let link = self.link.as_ref()?.replace("{participants}", &format!("{first},{second}"));
        Some(link.replace("{trial}", &(trial + 1).to_string()).replace("{run}", &run.to_string()))
    }

    /// Whether both drivers are asked how they are once a trial is done.
    pub fn asks_after(&self, trial: usize) -> bool {
        match self.questions {
            Questions::Never => false,
            Questions::EachHalf => self.trials[trial].ends_half,
            Questions::EachTrial => true,
        }
    }
}

/// A condition, driven by those who sit where they began.
fn trial(condition: &Condition, folder: &Path, checkpoint: usize, place: &dyn Fn() -> String) -> anyhow::Result<Trial> {
    let usage = |reason: String| Usage(format!("{}: {reason}", place()));
    let changes = condition.changes().map_err(usage)?;
    let km = condition.km().map_err(usage)?;
    let beside = |name: &String| folder.join(name);
    let setting = match (&condition.map, &condition.scenario) {
        (Some(_), Some(_)) => return Err(usage("expected map or scenario, not both".into()).into()),
        (None, Some(name)) => {
            let path = Some(beside(name)).filter(|path| path.exists()).unwrap_or_else(|| name.into());
            Setting::of_scenario(&path)
        }
        (Some(name), None) if name.contains('.') => Setting::of_map(&beside(name).to_string_lossy()),
        (name, None) => Setting::of(None, name.as_deref()),
    };
    let setting = setting.with_context(place)?;
    let scenario = setting.scenario(None, &changes);
    scenario.start_on(&setting.map.network).map_err(|error| usage(error.reason))?;
    Ok(Trial { setting, scenario, checkpoint, km, is_swapped: false, begins_half: false, ends_half: false })
}

/// Conditions in an order, and then backwards with seats swapped, if they are to be.
fn in_halves(conditions: &[Trial], order: &[usize], swap: bool) -> Vec<Trial> {
    let half = |order: Vec<usize>, is_swapped: bool| {
        let last = order.len() - 1;
        order.into_iter().enumerate().map(move |(place, condition)| Trial {
            is_swapped,
            begins_half: is_swapped && place == 0,
            ends_half: place == last,
            ..conditions[condition].clone()
        })
    };
    let second = swap.then(|| half(order.iter().rev().copied().collect(), true));
    half(order.to_vec(), false).chain(second.into_iter().flatten()).collect()
}

/// First half of the digest of what a file says, comments and layout aside.
fn digest(text: &Text) -> anyhow::Result<String> {
    Ok(blake3::hash(toml::to_string(text)?.as_bytes()).to_hex()[..32].to_owned())
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn read(text: &str) -> Result<Protocol, String> {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("plan.toml");
        fs::write(&path, text).expect("written");
        Protocol::read(&path).map_err(|error| format!("{error:#}").replace(&format!("{}/", dir.path().display()), ""))
    }

    const PAIR: &str = "participants = [\"P07\", \"P03\"]\n";

    fn pair(more: &str) -> Result<Protocol, String> {
        read(&format!("{PAIR}{more}"))
    }

    #[test]
    fn conditions_are_driven_by_a_row_of_the_square_and_backwards_with_seats_swapped() {
        let conditions = ["early", "full", "truth"].map(|name| format!("[[conditions]]\ncheckpoint = \"{name}\"\n"));
        let told = |more: &str| {
            let protocol = pair(&format!("{more}\n{}", conditions.concat())).expect("valid");
            let words = |trial: &Trial| (trial.checkpoint, trial.is_swapped);
            protocol.trials.iter().map(words).collect::<Vec<_>>()
        };
        assert_eq!(told(""), [(0, false), (1, false), (2, false), (2, true), (1, true), (0, true)]);
        assert_eq!(told("row = 2\nswap = false"), [(1, false), (2, false), (0, false)]);
        assert_eq!(told("row = 2\norder = \"as-written\"\nswap = false"), [(0, false), (1, false), (2, false)]);
        let protocol =
            pair(&format!("blind = true\nquestions = \"each-half\"\n{}", conditions.concat())).expect("valid");
        let asks: Vec<usize> = (0..6).filter(|trial| protocol.asks_after(*trial)).collect();
        assert_eq!((asks, protocol.study().blind.len()), (vec![2, 5], 3));
        assert_eq!(protocol.words(4), "trial 5 of 6: city");
    }

    #[test]
    fn a_recording_is_of_a_trial_of_its_plan_however_its_file_is_laid_out() {
        let [one, same, other] = [
            "[[conditions]]\nmap = \"rural\"\nkm = 2.5",
            "# of Monday\n[[conditions]]\nkm = 2.50\nmap = \"rural\"",
            "[[conditions]]\nmap = \"city\"\nkm = 2.5",
        ]
        .map(|text| pair(text).expect("valid"));
        assert_eq!((same.trial_of(&one.provenance(1)), same.words(1)), (Ok(1), "trial 2 of 2: rural, 2.5 km".into()));
        assert!(other.trial_of(&one.provenance(1)).unwrap_err().starts_with("is of another plan than"));
        assert!(one.trial_of(&Provenance::default()).unwrap_err().starts_with("was not driven by a plan"));
        let seeds = [(0, 0), (0, 1), (1, 0)].map(|(trial, earlier)| one.scenario(trial, earlier).seed);
        assert!(seeds[0] != seeds[1] && seeds[0] != seeds[2] && seeds[1] != seeds[2], "{seeds:?}");
    }

    #[test]
    fn links_name_run_and_people() {
        let protocol = pair("link = \"https://forms.test/?who={participants}&at={trial}.{run}\"\n[[conditions]]\n");
        let link = protocol.expect("valid").link(1, 4);
        assert_eq!(link.as_deref(), Some("https://forms.test/?who=P07,P03&at=2.4"));
    }

    #[test]
    fn what_cannot_be_driven_is_said_with_file_and_key() {
        for (text, words) in [
            ("participants = [\"P07\", \"P07\"]\n[[conditions]]", "plan.toml: participants: expected two different"),
            ("participants = [\"P 7\", \"P03\"]\n[[conditions]]", "plan.toml: participants: expected a pseudonym"),
            ("participants = [\"P07\"]\n[[conditions]]", "plan.toml: line 1: "),
            ("participants = [\"P07\", \"P03\"]", "plan.toml: line 1: missing field `conditions`"),
            ("participants = [\"P07\", \"P03\"]\nconditions = []", "plan.toml: conditions: expected 1 to 40, found 0"),
        ] {
            let said = read(text).expect_err(text);
            assert!(said.starts_with(words), "{said:?}, not {words:?}");
        }
        for (text, words) in [
            ("row = 0\n[[conditions]]", "plan.toml: row: expected 1 or more"),
            ("[[conditions]]\nmap = \"citty\"", "plan.toml: condition 1: unknown map \"citty\""),
            (
                "[[conditions]]\n[[conditions]]\nweather = \"Sunny\"",
                "plan.toml: condition 2: weather: unknown \"Sunny\"",
            ),
            ("[[conditions]]\nkm = -1.0", "plan.toml: condition 1: km is -1"),
            ("[[conditions]]\nmax_time_s = 3", "plan.toml: condition 1: max_time_s is 3"),
            (
                "[[conditions]]\nmap = \"city\"\nscenario = \"a.toml\"",
                "plan.toml: condition 1: expected map or scenario",
            ),
            ("[[conditions]]\nscenario = \"a.toml\"", "plan.toml: condition 1: "),
            ("blind = true\n[[conditions]]", "plan.toml: blind: expected conditions with two or more checkpoints"),
            ("[[conditions]]\nspeed = 3", "plan.toml: line 3: unknown field `speed`"),
            ("[[conditions]]\ncheckpoint = \"\"", "plan.toml: condition 1: checkpoint: nothing is named"),
        ] {
            let said = pair(text).expect_err(text);
            assert!(said.starts_with(words) && !said.contains('\n'), "{said:?}, not {words:?}");
        }
    }
}
