//! A gallery: its pictures are those that `aeye render` makes, it is gone on with, and no other's folder is touched.

use std::fs;

use base::png;
use tests::command::aeye;

const GALLERY: &str = "gallery --maps rural --seed 3 --at 0.5s --size 64x32 --quality plain";

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_gallery_has_every_light_and_is_gone_on_with() {
    let dir = tempfile::tempdir().unwrap();
    let out = dir.path().join("gallery");
    assert_eq!(aeye(GALLERY, &[], &out), (0, String::new()));
    let files = || -> Vec<String> {
        let names = fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = names.collect();
        names.sort();
        names
    };
    let all = ["gallery.json", "index.html", "rural-dusk.png", "rural-fog.png", "rural-night.png", "rural-noon.png"];
    assert_eq!(files(), [&all[..], &["rural-rain.png"]].concat());
    let bytes = |name: &str| fs::read(out.join(name)).unwrap();
    let before: Vec<Vec<u8>> = files().iter().map(|name| bytes(name)).collect();
    let brightness = |light: &str| {
        let (_, rgb) = png::read(&out.join(format!("rural-{light}.png")), 3).unwrap();
        rgb.iter().map(|byte| u64::from(*byte)).sum::<u64>()
    };
    assert!(brightness("noon") > brightness("dusk") && brightness("dusk") > brightness("night"));
    // As if it had been killed; a picture that is there is not made again.
    fs::remove_file(out.join("rural-fog.png")).unwrap();
    fs::write(out.join("rural-noon.png"), "kept").unwrap();
    assert_eq!(aeye(GALLERY, &[], &out), (0, String::new()));
    assert_eq!(bytes("rural-noon.png"), b"kept");
    fs::remove_file(out.join("rural-noon.png")).unwrap();
    assert_eq!(aeye(GALLERY, &[], &out), (0, String::new()));
    assert!(files().iter().map(|name| bytes(name)).eq(before));
}

#[test]
fn a_folder_of_something_else_stays_as_it_is() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("notes.txt"), "mine").unwrap();
    let (code, said) = aeye(GALLERY, &[], dir.path());
    assert!(code == 1 && said.contains("holds other files"), "{said}");
    fs::remove_file(dir.path().join("notes.txt")).unwrap();
    fs::write(dir.path().join("gallery.json"), "{}").unwrap();
    let (code, said) = aeye(GALLERY, &[], dir.path());
    assert!(code == 1 && said.contains("is another gallery's"), "{said}");
    assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
}
