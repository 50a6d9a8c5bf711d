//! Runs of a campaign one by one, by whichever process. Each waits in the campaign's folder until its turn comes, and a
//! campaign that is driven there afterwards finds it.

use anyhow::bail;
use base::progress::Interrupt;

use super::aside::Aside;
use super::drive::open;
use super::kept;
use super::options::{Options, plan};
use super::places::Places;
use super::plan::Plan;
use super::run_line::RunLine;
use super::runner::Runner;
use super::task::Task;
use super::until::Until;
use crate::share::Share;

/// Drives a run through each checkpoint, unless it is there.
pub fn drive_run(options: &Options, run: u32, interrupt: &Interrupt) -> anyhow::Result<()> {
    let (plan, eyes) = open(options)?;
    let task = Task { plan: &plan, share: Share::WHOLE, adapters: &[], jobs: 1, interrupt };
    for eye in &eyes {
        let aside = Aside::new(&plan.out, eye.name());
        if Runner::new(&task, eye, &aside).drive(run)?.is_none() {
            bail!("interrupted; the same command drives it again");
        }
    }
    Ok(())
}

/// Runs through each checkpoint, by their names, that are not there and count for certain: even if each brought the
/// campaign as far as a run can, none before the last of them would be enough.
pub fn missing_runs(options: &Options) -> anyhow::Result<Vec<(String, u32)>> {
    let plan = plan(options)?;
    let mut missing = Vec::new();
    for checkpoint in &options.checkpoint {
        let name = checkpoint.name().into_owned();
        let runs = needed(plan.goal.until, plan.run_seconds, |run| known(&plan, &name, run))?;
        missing.extend(runs.into_iter().map(|run| (name.clone(), run)));
    }
    Ok(missing)
}

/// Numbers of runs that count for certain and of which nothing is known.
fn needed(
    until: Until,
    run_seconds: u32,
    known: impl Fn(u32) -> anyhow::Result<Option<RunLine>>,
) -> anyhow::Result<Vec<u32>> {
    let (mut lines, mut missing) = (Vec::new(), Vec::new());
    for run in 0.. {
        let (done, of) = until.progress(&lines);
        // Where nothing helps any more, driving the campaign says so.
        let is_hopeless = missing.is_empty() && until.is_out_of_reach(&lines);
        if is_hopeless || done + until.most_of_a_run(run_seconds) * missing.len() as u64 >= of {
            break;
        }
        match known(run)? {
            Some(line) => lines.push(line),
            None => missing.push(run),
        }
    }
    Ok(missing)
}

/// What is kept of a run, in its place or where it waits; `None` unless all of its files are there.
fn known(plan: &Plan, checkpoint: &str, run: u32) -> anyhow::Result<Option<RunLine>> {
    let (places, aside) = (Places::new(&plan.out, checkpoint, run), Aside::new(&plan.out, checkpoint));
    let there = Places {
        recording: aside.find(&places.recording),
        case: aside.find(&places.case),
        counterfactual: aside.find(&places.counterfactual),
    };
    let network = &plan.maps[plan.map_index(run)].network;
    match kept::read(checkpoint, &there, |_| Ok(network.clone())) {
        // It was given its place meanwhile; who drives it finds it there.
        Err(_) if !there.recording.exists() => Ok(None),
        read => Ok(read?.map(|(_, line)| line)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_needed_that_may_not_count() {
        let none = |_| Ok(None);
        assert_eq!(needed(Until::Runs(3), 90, none).expect("readable"), [0, 1, 2]);
        assert_eq!(needed(Until::PedestrianCases(2), 90, none).expect("readable"), [0, 1]);
        let km = needed(Until::Km(2.0), 90, none).expect("readable");
        assert_eq!(km, [0, 1], "90 s are 1.25 km at most");
    }
}
