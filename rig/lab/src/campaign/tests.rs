//! Campaigns on paper.

use std::collections::BTreeMap;

use base::room::RoadUsers;
use kernel::arbiter::Outcome;
use measures::run_figures::RunFigures;
use measures::run_outcome::RunOutcome;
use measures::statistics::Ride;

use super::figures;
use super::run_line::RunLine;
use super::until::{Goal, STALLED_RUNS, Until};

fn runs(each: impl IntoIterator<Item = (f64, bool)>) -> Vec<RunLine> {
    let figures = |km| RunFigures {
        drawn: BTreeMap::new(),
        map: "city".into(),
        seed: 1,
        km,
        minutes: 1.0,
        asked: RoadUsers::default(),
        missing: None,
        outcome: RunOutcome::Ended(Outcome::Censored),
        familiarisation: false,
        label: None,
        comment: None,
        perception_caused: None,
    };
    let run = |(km, is_case): (f64, bool)| RunLine {
        file: "a.mcap".into(),
        case: is_case.then(|| "a.case.mcap".into()),
        checkpoint: "full".into(),
        without_intervention: None,
        figures: figures(km),
        ride: None,
    };
    each.into_iter().map(run).collect()
}

#[test]
fn a_campaign_that_gets_nowhere_is_given_up_and_a_slow_one_is_not() {
    let nothing = || std::iter::repeat_n((0.0, false), STALLED_RUNS);
    let stalled = runs(std::iter::once((1.1, true)).chain(nothing()));
    let slow = runs(nothing().chain([(1.1, true)]));
    for until in [Until::Km(2.0), Until::Cases(2)] {
        assert!(until.is_out_of_reach(&stalled) && until.is_out_of_reach(&runs(nothing())), "{until:?}");
        assert!(!until.is_out_of_reach(&stalled[..STALLED_RUNS]) && !until.is_out_of_reach(&slow), "{until:?}");
    }
    assert!(!Until::Runs(1000).is_out_of_reach(&stalled));
    assert!(Until::PedestrianCases(1).is_out_of_reach(&slow), "no case is labelled walker");
}

#[test]
fn figures_know_what_ended_the_campaign() {
    let rides =
        |km: f64| Ride { km, minutes: km, is_case: true, label: None, perception_caused: None, tempers: [None; 2] };
    let mut lines = runs([(2.0, true), (3.0, true)]);
    lines.iter_mut().for_each(|line| line.ride = Some(rides(line.figures.km)));
    let of = |until| figures(1, until, &["full".to_owned()], lines.clone());
    let high = |until| of(until).checkpoints[0].statistics.cases_per_km_95.1;
    assert!(high(Until::Cases(2)) < high(Until::Km(5.0)) && high(Until::Km(5.0)) == high(Until::Runs(2)));
    let json = |until| serde_json::to_value(of(until)).expect("it has names");
    let (by_cases, by_km) = (json(Until::PedestrianCases(2)), json(Until::Km(5.0)));
    assert_eq!(by_cases["until"], serde_json::json!({ "kind": "pedestrian_cases", "value": 2 }));
    assert_eq!(by_km["until"], serde_json::json!({ "kind": "km", "value": 5.0 }));
    assert_eq!(
        (&by_cases["checkpoints"][0]["sampling"], &by_km["checkpoints"][0]["sampling"]),
        (&"cases".into(), &"length".into())
    );
}

#[test]
fn a_goal_is_one_thing_and_something() {
    let of = |runs, km, cases| Goal::of(runs, km, [cases, None]);
    assert_eq!(of(Some(3), None, None), Some(Until::Runs(3).into()));
    assert_eq!(of(Some(3), Some(0.5), None), Some(Goal { until: Until::Km(0.5), most: Some(3) }));
    assert_eq!(of(None, None, Some(2)), Some(Until::Cases(2).into()));
    assert_eq!(Goal::of(None, None, [None, Some(2)]), Some(Until::PedestrianCases(2).into()));
    let none = [
        (None, None, None),
        (None, Some(1.0), Some(1)),
        (None, Some(0.0), None),
        (None, Some(f64::NAN), None),
        (Some(0), None, None),
        (None, None, Some(0)),
        (Some(0), Some(1.0), None),
    ];
    assert!(none.into_iter().all(|(runs, km, cases)| of(runs, km, cases).is_none()));
    assert!([None, Some(1)].into_iter().all(|cases| Goal::of(None, None, [cases, Some(0)]).is_none()));
    assert!(Goal::of(None, None, [Some(1), Some(1)]).is_none());
}
