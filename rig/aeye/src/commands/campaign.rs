//! Simulated drives in parallel, resumable, and their figures.

use base::failure::Usage;
use base::progress::Interrupt;
use lab::campaign::{Collection, Goal, Options, Until, collect, drive, drive_shard, plan};

use crate::cli::CampaignArgs;
use crate::exit::Verdict;
use crate::print;

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
    let goal = goal(args)?;
    let CampaignArgs {
        checkpoint,
        maps,
        embed_map,
        scenario,
        pedestrians,
        hazards,
        weather,
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
        goal,
        pedestrians,
        hazards,
        weather,
        run_seconds,
        seed,
        jobs,
        out,
    })
}

fn goal(args: &CampaignArgs) -> anyhow::Result<Goal> {
    let until = match (args.km, args.cases, args.pedestrian_cases) {
        (Some(km), None, None) if km > 0.0 && km.is_finite() => Some(Until::Km(km)),
        (None, Some(cases), None) => Some(Until::Cases(cases)),
        (None, None, Some(cases)) => Some(Until::PedestrianCases(cases)),
        (None, None, None) => None,
        _ => return Err(Usage("expected one of --km (more than 0), --cases and --pedestrian-cases".into()).into()),
    };
    match (until, args.runs) {
        (Some(until), most) => Ok(Goal { until, most }),
        (None, Some(runs)) => Ok(Until::Runs(runs).into()),
        // Only the first one is printed.
        (None, None) => Ok(Until::Runs(1).into()),
    }
}
