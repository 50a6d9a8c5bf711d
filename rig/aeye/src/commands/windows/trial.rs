//! How well bots keep real time in windows, and what follows from it for drives on this machine.

use live::drive::{self, LiveFigures};

use crate::cli::DoctorArgs;

/// Sizes of the safety driver's picture, largest first.
const SIZES: [(u32, u32); 5] = [(1280, 720), (960, 540), (640, 360), (480, 270), (320, 180)];
/// Pictures a second that leave room for a busy street.
const ENOUGH_FPS: f64 = 18.0;
/// Pictures a second from which on nearly every tick has one, and the machine may have more to give.
const ALL_FPS: f64 = 50.0;
/// Median age of masks from which on they should be made quicker, milliseconds.
const OLD_MASK_MS: f64 = 100.0;

/// What a drive of bots in windows came to, and what to use here.
pub fn trial(args: &DoctorArgs) -> anyhow::Result<(LiveFigures, Vec<String>)> {
    let figures = drive::trial(&args.checkpoint, &(&args.pictures).into(), args.seconds)?;
    Ok((figures, advice(args, &figures)))
}

/// What to use here, from how it went with these sizes: pictures of the largest of [`SIZES`] that should
/// come often enough, and masks that should be young enough.
fn advice(args: &DoctorArgs, figures: &LiveFigures) -> Vec<String> {
    let pixels = |(width, height): (u32, u32)| f64::from(width * height);
    // As if the time of a picture went with its pixels, which overstates what smaller ones bring.
    let fps = |size| figures.safety_fps * pixels(args.pictures.image_size) / pixels(size);
    let size = SIZES.into_iter().find(|size| fps(*size) >= ENOUGH_FPS).unwrap_or(SIZES[SIZES.len() - 1]);
    let larger = SIZES.into_iter().rev().find(|size| pixels(*size) > pixels(args.pictures.image_size));
    let mut said = figures.shortfalls();
    said.push(match larger {
        Some((width, height)) if figures.safety_fps >= ALL_FPS => {
            format!("there is room for larger pictures: measure --image-size {width}x{height}")
        }
        _ if size == args.pictures.image_size => "the safety driver's pictures suit this machine".into(),
        _ => format!("drive with --image-size {}x{}", size.0, size.1),
    });
    let masks_are_old =
        figures.mask_age_ms.is_none_or(|age| age.median > OLD_MASK_MS) || figures.semantic_fps < ENOUGH_FPS;
    said.push(match masks_are_old {
        true => "for younger masks: a smaller --mask-size or checkpoint, and no other window over the drivers'".into(),
        false => "masks of this checkpoint and size suit this machine, with all three windows".into(),
    });
    said
}
