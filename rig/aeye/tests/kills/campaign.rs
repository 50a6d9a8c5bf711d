//! Campaigns, and what is made of corner cases.

use std::path::Path;

use crate::cases::case;
use crate::ordeal::survive;
use crate::street::street;

/// Corner cases in `ROOT/cases`.
fn prepare(root: &Path) {
    let folder = root.join("cases");
    std::fs::create_dir(&folder).expect("writable");
    (1..=3).for_each(|seed| case(&folder.join(format!("{seed}.case.mcap")), seed));
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_campaign_goes_on() {
    let arguments = "campaign --checkpoint early --maps ../street.xodr --pedestrians 60 --cases 1 --max-time 12s \
                     --seed 3 --jobs 3 --out out";
    survive("campaign", arguments, |root| street(&root.join("street.xodr")), |_, _| ());
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn forks_go_on() {
    let arguments = "redrive ../cases --checkpoint truth --vary 1 --after 1s --jobs 2 --out out";
    survive("redrive", arguments, prepare, |_, _| ());
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_comparison_goes_on() {
    let arguments = "compare ../cases --checkpoint early,full --jobs 2 --out out";
    survive("compare", arguments, prepare, |_, _| ());
}
