//! Simulated drives in parallel, resumable, and their figures.

use base::failure::Usage;
use base::progress::Interrupt;
use lab::campaign::{Options, Until, drive, plan};

use crate::cli::CampaignArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye campaign`.
pub fn run(args: &CampaignArgs, json: bool) -> anyhow::Result<Verdict> {
    let options = options(args)?;
    if args.print_scenario {
        print::text(&plan(&options)?.scenario_of(0).to_toml())?;
        return Ok(Verdict::Ok);
    }
    print::result(json, &drive(&options, &Interrupt::listen())?)?;
    Ok(Verdict::Ok)
}

fn options(args: &CampaignArgs) -> anyhow::Result<Options> {
    if args.pedestrian_cases.is_some() && args.pedestrians == Some(0) {
        return Err(Usage("--pedestrian-cases without people on foot; expected --pedestrians above 0".into()).into());
    }
    let until = until(args)?;
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
        until,
        pedestrians,
        hazards,
        weather,
        run_seconds,
        seed,
        jobs,
        out,
    })
}

fn until(args: &CampaignArgs) -> anyhow::Result<Until> {
    match (args.runs, args.km, args.cases, args.pedestrian_cases) {
        (Some(runs), None, None, None) => Ok(Until::Runs(runs)),
        (None, Some(km), None, None) if km > 0.0 && km.is_finite() => Ok(Until::Km(km)),
        (None, None, Some(cases), None) => Ok(Until::Cases(cases)),
        (None, None, None, Some(cases)) => Ok(Until::PedestrianCases(cases)),
        (None, None, None, None) if args.print_scenario => Ok(Until::Runs(1)),
        _ => Err(Usage("expected one of --runs, --km (more than 0), --cases and --pedestrian-cases".into()).into()),
    }
}
