//! What computes networks besides the CPU: the same masks, or one sentence that says what is missing. Where the library of
//! onnxruntime is named in `ORT_DYLIB_PATH` it must work.

use std::io::{Write, stderr};
use std::path::Path;
use std::process::Command;

use crate::metadata::Layout;
use crate::onnx::pb::tensor_proto::DataType;
use crate::toy::{self, Tail, Toy, picture};
use crate::{
    BUNDLED, Checkpoint, Compute, Mask, PerceptionError, RgbView, Segmenter, bundled, forms, onnxruntime, zoo,
};

/// Where onnxruntime is.
const LIBRARY: &str = "ORT_DYLIB_PATH";

/// Says something although the test passes.
fn say(text: &str) {
    writeln!(stderr(), "{text}").unwrap();
}

/// Whether the tests of onnxruntime can run; says so where they cannot.
fn has_onnxruntime() -> bool {
    let named = std::env::var_os(LIBRARY).is_some_and(|path| !path.is_empty());
    if !named {
        say(&format!("not run: {LIBRARY} names no library of onnxruntime"));
    }
    named
}

fn look(compute: Compute, checkpoint: &Checkpoint, (width, height): (usize, usize)) -> Result<Mask, PerceptionError> {
    let mut segmenter = Segmenter::on(compute, checkpoint, width, height)?;
    assert_eq!(segmenter.compute(), compute);
    let rgb = picture(width, height);
    let image = RgbView::new(width, height, &rgb)?;
    let mask = segmenter.run(image)?;
    assert_eq!(segmenter.clone().run(image)?, mask, "a clone sees the same");
    Ok(mask)
}

/// Share of the pixels that two masks have in common.
fn same(a: &Mask, b: &Mask) -> f64 {
    assert_eq!((a.width, a.height), (b.width, b.height));
    let same = a.ids.iter().zip(&b.ids).filter(|(a, b)| a == b).count();
    same as f64 / a.ids.len() as f64
}

#[test]
fn every_device_sees_the_same_or_says_what_is_missing() {
    for name in BUNDLED {
        let checkpoint = bundled(name).unwrap().unwrap();
        let cpu = look(Compute::Cpu, &checkpoint, (256, 128)).unwrap();
        for compute in Compute::ALL {
            match look(compute, &checkpoint, (256, 128)) {
                Ok(mask) => assert!(same(&cpu, &mask) >= 0.99, "{name} on {}: {}", compute.name(), same(&cpu, &mask)),
                Err(error) => {
                    let text = error.to_string();
                    let start = format!("inference on {} does not work here: ", compute.name());
                    assert!(text.starts_with(&start) && !text.contains('\n'), "{text}");
                    assert_ne!(compute, Compute::Cpu, "{text}");
                }
            }
        }
    }
}

#[test]
fn onnxruntime_gives_the_masks_of_the_cpu() {
    if !has_onnxruntime() {
        return;
    }
    let dir = tempfile::tempdir().unwrap();
    let compare = |checkpoint: &Checkpoint, size| {
        let [cpu, other] = [Compute::Cpu, Compute::OnnxRuntime].map(|compute| look(compute, checkpoint, size).unwrap());
        assert!(
            same(&cpu, &other) >= 0.999,
            "{}: {} of the pixels are the same",
            checkpoint.name(),
            same(&cpu, &other)
        );
    };
    for name in BUNDLED {
        compare(&bundled(name).unwrap().unwrap(), (256, 128));
    }
    let mut models = zoo::networks();
    models.push(forms::several(&Toy::default(), 4, false));
    for layout in [Layout::Nchw, Layout::Nhwc] {
        for element in [DataType::Float, DataType::Uint8, DataType::Int64, DataType::Float16, DataType::Double] {
            for tail in [Tail::None, Tail::Upsample, Tail::Argmax, Tail::CoarseArgmax] {
                for size in [None, Some((16, 32))] {
                    models.push(Toy { layout, element, tail, size, ..Toy::default() }.model());
                }
            }
        }
    }
    for (number, model) in models.iter().enumerate() {
        let path = toy::write(dir.path(), &format!("network-{number}.onnx"), model);
        compare(&Checkpoint::load(path).unwrap(), (32, 16));
    }
}

/// What a process says that looks for its library there; a process loads one, and once.
fn said(library: &Path) -> String {
    let test = "devices::the_library_of_onnxruntime_works_or_is_missed";
    let mut child = Command::new(std::env::current_exe().unwrap());
    let output = child.args(["--exact", test]).env(LIBRARY, library).output().unwrap();
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{text}");
    text
}

#[test]
fn the_library_of_onnxruntime_works_or_is_missed() {
    let Err(missed) = onnxruntime() else { return };
    assert!(!missed.contains('\n') && missed.contains("`pip install onnxruntime`"), "{missed}");
    assert_eq!(onnxruntime().err(), Some(missed.clone()), "it is missed again");
    say(&missed);
}

#[test]
fn a_library_that_is_none_is_told_with_what_to_do() {
    let dir = tempfile::tempdir().unwrap();
    let absent = dir.path().join("absent.so");
    let text = dir.path().join("text.so");
    std::fs::write(&text, "no library").unwrap();
    for (library, what) in [
        (absent.as_path(), "the library of onnxruntime cannot be loaded"),
        (&text, "the library of onnxruntime cannot be loaded"),
        (Path::new("libc.so.6"), "libc.so.6 is no library of onnxruntime"),
    ] {
        let said = said(library);
        assert!(said.contains(what) && said.contains(&library.display().to_string()), "{said}");
        assert!(said.contains("and set ORT_DYLIB_PATH to"), "{said}");
    }
}
