//! Simulated drives in parallel, resumable, and their figures.

use base::failure::Usage;
use base::progress::Interrupt;
use lab::campaign::{Collection, Goal, Options, collect, drive, drive_shard, plan};

use crate::cli::CampaignArgs;
use crate::exit::Verdict;
use crate::print;

const GOAL: &str = "expected --runs, --vary, or one of --km (more than 0), --cases and --pedestrian-cases";

/// Runs `aeye campaign`.
pub fn run(args: &CampaignArgs, json: bool) -> anyhow::Result<Verdict> {
    if args.collect {
        let (folders, out) = (args.folders.clone(), args.out.clone().unwrap_or_default());
        print::result(json, &collect(&Collection { folders, jobs: args.jobs, out })?)?;
        return Ok(Verdict::Ok);
    }
    if let Some(folder) = args.folders.first() {
        let folder = folder.display();
        return Err(
            Usage(format!("{folder}: is given to a campaign; expected --collect, which alone takes folders")).into()
        );
    }
    let options = options(args)?;
    if args.print_scenario {
        print::text(&plan(&options)?.scenario_of(0).to_toml())?;
        return Ok(Verdict::Ok);
    }
    let interrupt = Interrupt::listen();
    match args.shard {
        Some(share) => print::result(json, &drive_shard(&options, share, &interrupt)?)?,
        None => print::result(json, &drive(&options, &interrupt)?)?,
    }
    Ok(Verdict::Ok)
}

fn options(args: &CampaignArgs) -> anyhow::Result<Options> {
    if args.pedestrian_cases.is_some() && args.pedestrians == Some(0) {
        return Err(Usage("--pedestrian-cases without people on foot; expected --pedestrians above 0".into()).into());
    }
    // Only the first run is printed.
    let runs = args.runs.or(args.vary).or(args.print_scenario.then_some(1));
    let goal = Goal::of(runs, args.km, [args.cases, args.pedestrian_cases]).ok_or_else(|| Usage(GOAL.into()))?;
    let CampaignArgs {
        checkpoint,
        maps,
        embed_map,
        scenario,
        pedestrians,
        hazards,
        weather,
        imaging,
        run_seconds,
        seed,
        jobs,
        out,
        ..
    } = args.clone();
    // Nothing goes anywhere where the scenario is only printed.
    let out = out.unwrap_or_default();
    Ok(Options {
        checkpoint,
        maps,
        embed_map,
        scenario,
        vary: args.vary.is_some(),
        goal,
        pedestrians,
        hazards,
        weather,
        imaging: imaging.into(),
        run_seconds,
        seed,
        jobs,
        out,
    })
}
