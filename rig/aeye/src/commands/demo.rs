//! The main job from end to end.

use base::progress::Interrupt;
use lab::demo::{Onlooker, Options, demo};
use lab::rerender::Rerendered;
use lab::verify::Checked;

use crate::cli::DemoArgs;
use crate::exit::Verdict;
use crate::print;

/// Prints what comes about on the way.
struct Printer {
    json: bool,
}

impl Onlooker for Printer {
    fn checked(&mut self, checked: &Checked) -> anyhow::Result<()> {
        print::result(self.json, checked)
    }

    fn rerendered(&mut self, rerendered: &Rerendered) -> anyhow::Result<()> {
        print::result(self.json, rerendered)
    }
}

/// Runs `aeye demo`.
pub fn run(args: &DemoArgs, json: bool) -> anyhow::Result<Verdict> {
    let DemoArgs { seed, jobs, out } = args.clone();
    let made = demo(&Options { seed, jobs, out }, &mut Printer { json }, &Interrupt::listen())?;
    print::result(json, &made)?;
    Ok(Verdict::Ok)
}
