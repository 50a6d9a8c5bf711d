//! Simulated drives in parallel, resumable, and their figures.

use std::collections::BTreeSet;
use std::fmt::Write;

use render::AdapterChoice;

use crate::campaign::{CampaignFigures, Plan, Until, drive_all, figures};
use crate::cli::CampaignArgs;
use crate::exit::{Usage, Verdict};
use crate::lab::spread::jobs;
use crate::maps::{Map, read_scenario};
use crate::output;
use crate::progress::Interrupt;
use crate::statistics::table;
use crate::vision::Eye;

/// Runs `aeye campaign`.
pub fn run(args: &CampaignArgs, json: bool) -> anyhow::Result<Verdict> {
    let figures = drive(args, &Interrupt::listen()?)?;
    output::print(json, &figures, || text(&figures))?;
    Ok(Verdict::Ok)
}

/// Drives a campaign, writes its files, and gives its figures.
pub fn drive(args: &CampaignArgs, interrupt: &Interrupt) -> anyhow::Result<CampaignFigures> {
    let plan = plan(args)?;
    let eyes = args.checkpoint.iter().map(Eye::open).collect::<Result<Vec<_>, _>>()?;
    let names: Vec<String> = eyes.iter().map(|eye| eye.name().to_owned()).collect();
    if names.iter().collect::<BTreeSet<_>>().len() < names.len() {
        return Err(Usage("two checkpoints have the same file name; expected names that differ".into()).into());
    }
    AdapterChoice::default().find()?;
    output::create_folder(&plan.out)?;
    let jobs = jobs(args.jobs);
    let mut runs = Vec::new();
    for eye in &eyes {
        runs.extend(drive_all(&plan, eye, jobs, interrupt)?);
    }
    let figures = figures(plan.seed, &names, runs);
    output::write_file(&plan.out.join("campaign.json"), output::json_file(&figures)?.as_bytes())?;
    Ok(figures)
}

fn plan(args: &CampaignArgs) -> anyhow::Result<Plan> {
    let scenario = args.scenario.as_deref().map(read_scenario).transpose()?;
    let maps = match &scenario {
        Some((_, map)) if args.maps.is_empty() => vec![map.clone()],
        _ if args.maps.is_empty() => Map::find_all(&["all".to_owned()])?,
        _ => Map::find_all(&args.maps)?,
    };
    if args.pedestrian_cases.is_some() && args.pedestrians == Some(0) {
        return Err(Usage("--pedestrian-cases without people on foot; expected --pedestrians above 0".into()).into());
    }
    let until = match (args.runs, args.km, args.cases, args.pedestrian_cases) {
        (Some(runs), None, None, None) => Until::Runs(runs),
        (None, Some(km), None, None) if km > 0.0 && km.is_finite() => Until::Km(km),
        (None, None, Some(cases), None) => Until::Cases(cases),
        (None, None, None, Some(cases)) => Until::PedestrianCases(cases),
        _ => {
            return Err(
                Usage("expected one of --runs, --km (more than 0), --cases and --pedestrian-cases".into()).into()
            );
        }
    };
    let scenario = scenario.map(|(scenario, _)| scenario);
    let (pedestrians, run_seconds, seed, out) = (args.pedestrians, args.run_seconds, args.seed, args.out.clone());
    Ok(Plan { maps, scenario, pedestrians, run_seconds, seed, until, out })
}

fn text(figures: &CampaignFigures) -> String {
    let columns = figures.checkpoints.iter().map(|c| (c.checkpoint.as_str(), &c.statistics, c.against_first.as_ref()));
    let mut text = table(columns);
    for each in figures.checkpoints.iter().filter(|each| !each.interventions.is_empty()) {
        let verdicts: Vec<_> = each.interventions.iter().map(|(verdict, n)| format!("{n} {verdict}")).collect();
        // Writing to a string cannot fail.
        let _ = write!(text, "\n{}: without the interventions: {}", each.checkpoint, verdicts.join(", "));
    }
    text
}
