//! Datasets: frames with ground truth in the layout of Cityscapes.

use base::progress::Interrupt;
use lab::dataset::{cases, mix, natural, rebuild};

use crate::cli::{CasesArgs, MixArgs, NaturalArgs, RebuildArgs};
use crate::exit::Verdict;
use crate::print::{self, print};

/// Runs `aeye dataset natural`.
pub fn natural(args: &NaturalArgs, json: bool) -> anyhow::Result<Verdict> {
    let NaturalArgs {
        scenes,
        val_scenes,
        test_scenes,
        frames,
        test_frames,
        size,
        imaging,
        cameras,
        maps,
        pedestrians,
        weather,
        seed,
        jobs,
        shard,
        out,
    } = args.clone();
    let options = natural::Options {
        scenes,
        val_scenes,
        test_scenes,
        frames,
        test_frames,
        size,
        imaging: imaging.into(),
        cameras,
        maps,
        pedestrians,
        weather,
        seed,
        jobs,
        out,
    };
    let interrupt = Interrupt::listen();
    if let Some(share) = shard {
        return super::share(json, &natural::make_shard(&options, share, &interrupt)?);
    }
    let manifest = natural::make(&options, &interrupt)?;
    print(json, &manifest, || manifest.sentence(&options.out))?;
    Ok(Verdict::Ok)
}

/// Runs `aeye dataset cases`.
pub fn cases(args: &CasesArgs, json: bool) -> anyhow::Result<Verdict> {
    let CasesArgs { files, label, verdict, split, size, imaging, cameras, jobs, out } = args.clone();
    let options = cases::Options { files, label, verdict, split, size, imaging: imaging.into(), cameras, jobs, out };
    let manifest = cases::make(&options, &Interrupt::listen())?;
    print(json, &manifest, || manifest.sentence(&options.out))?;
    Ok(Verdict::Ok)
}

/// Runs `aeye dataset mix`.
pub fn mix(args: &MixArgs, json: bool) -> anyhow::Result<Verdict> {
    let MixArgs { natural, pool, cases, replace, seed, out } = args.clone();
    let options = mix::Options { natural, pool, cases, replace, seed, out };
    print::result(json, &mix::make(&options, &Interrupt::listen())?)?;
    Ok(Verdict::Ok)
}

/// Runs `aeye dataset rebuild`.
pub fn rebuild(args: &RebuildArgs, json: bool) -> anyhow::Result<Verdict> {
    let RebuildArgs { recipe, cases, maps, jobs, out, .. } = args.clone();
    let options = rebuild::Options { recipe, cases, maps, jobs, out };
    let rebuilt = rebuild::make(&options, &Interrupt::listen())?;
    print(json, &rebuilt, || rebuilt.sentence(&options.out))?;
    Ok(Verdict::of_check(rebuilt.is_as_promised()))
}
