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
    let arguments = "campaign --checkpoint early --maps ../street.xodr --pedestrians 60 --cases 3 --max-time 15s \
                     --jobs 3 --out out";
    survive("campaign", arguments, |root| street(&root.join("street.xodr")), |_, _| ());
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn forks_go_on() {
    let arguments = "redrive ../cases --checkpoint early --vary 2 --after 3s --jobs 2 --out out";
    survive("redrive", arguments, prepare, |_, _| ());
}

#[test]
#[cfg_attr(no_vulkan, ignore = "no Vulkan driver is installed; AEYE_GPU=require makes this an error")]
fn a_comparison_goes_on() {
    let arguments = "compare ../cases --checkpoint early,full --jobs 2 --out out";
    survive("compare", arguments, prepare, |_, _| ());
}
