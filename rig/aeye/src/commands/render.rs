//! One picture of one moment.

use base::progress::Interrupt;
use base::setting::{Changes, Setting};
use lab::still::{Options, Subject, render};

use crate::cli::RenderArgs;
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye render`.
pub fn run(args: &RenderArgs, json: bool) -> anyhow::Result<Verdict> {
    let RenderArgs { at: tick, camera, cameras, layer, size, imaging, out, .. } = args.clone();
    let options = Options { subject: subject(args)?, tick, camera, cameras, layer, size, imaging: imaging.into(), out };
    for still in render(&options, &Interrupt::listen())? {
        print::result(json, &still)?;
    }
    Ok(Verdict::Ok)
}

fn subject(args: &RenderArgs) -> anyhow::Result<Subject> {
    if let Some(file) = &args.file {
        return Ok(Subject::File(file.clone()));
    }
    let setting = Setting::of(args.scenario.as_deref(), args.map.as_deref())?;
    let changes = Changes { weather: args.weather, pedestrians: args.pedestrians, ..Changes::default() };
    let scenario = Box::new(setting.scenario(args.seed, &changes));
    Ok(Subject::Run { map: Box::new(setting.map), scenario })
}
