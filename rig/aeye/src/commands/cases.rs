//! The library of cases: what is in it, and what people say about it.

use std::fmt::Write;

use base::failure::Failed;
use base::progress::Interrupt;
use lab::cases::query::Query;
use lab::cases::review::Change;
use lab::cases::{Answer, Options, cases};

use crate::cli::{LibraryArgs, QueryArgs};
use crate::exit::Verdict;
use crate::print;

/// Runs `aeye cases`.
pub fn run(args: &LibraryArgs, json: bool) -> anyhow::Result<Verdict> {
    let answer = cases(&options(args), &Interrupt::listen())?;
    show(args, &answer, json)?;
    Failed::check(&answer.overall.failed, answer.overall.read + answer.overall.kept)?;
    Ok(Verdict::Ok)
}

fn show(args: &LibraryArgs, answer: &Answer, json: bool) -> anyhow::Result<()> {
    if args.paths {
        let mut text = String::new();
        // Writing to a string cannot fail.
        answer.cases.iter().for_each(|case| {
            let _ = write!(text, "{}{}", case.file, if args.null { '\0' } else { '\n' });
        });
        return print::text(&text);
    }
    if json {
        answer.cases.iter().try_for_each(|case| print::print(true, case, String::new))?;
        return print::print(true, &answer.overall, String::new);
    }
    print::print(false, &answer.overall, || answer.to_string())
}

fn options(args: &LibraryArgs) -> Options {
    let LibraryArgs {
        places,
        index,
        no_scan,
        query,
        count,
        measure,
        recorded,
        set_review,
        add_tag,
        remove_tag,
        reveal,
        jobs,
        ..
    } = args.clone();
    let QueryArgs {
        label,
        verdict,
        map,
        weather,
        hazards,
        checkpoint,
        perception_caused,
        overlooked,
        ttc_below: ttc_below_s,
        fork_ttc_below: fork_ttc_below_s,
        reviewed,
        tag,
        near,
        unique,
        sort,
        descending,
        limit,
    } = query;
    let query = Query {
        label,
        verdict,
        map,
        weather,
        hazards,
        checkpoint,
        perception_caused,
        overlooked,
        ttc_below_s,
        fork_ttc_below_s,
        reviewed,
        tag,
        unique,
        sort,
        descending,
        limit,
    };
    let change = Change { review: set_review, add: add_tag, remove: remove_tag };
    Options { places, index, no_scan, query, near, count, reveal, measure, recorded, change, jobs }
}
