//! Stories that come with A-Eye: provoked accidents, each with ranges for its parameters. `kernel/stories/author.py` writes them.

/// The names of the bundled stories and their texts, in the order of the names.
#[rustfmt::skip]
pub const BUNDLED: [(&str, &str); 25] = [
    ("adult_along_the_lane_at_night", include_str!("../../stories/adult_along_the_lane_at_night.xosc")),
    ("adult_from_the_right", include_str!("../../stories/adult_from_the_right.xosc")),
    ("adult_runs_from_the_left", include_str!("../../stories/adult_runs_from_the_left.xosc")),
    ("adult_turns_back", include_str!("../../stories/adult_turns_back.xosc")),
    ("broken_down_at_night_in_rain", include_str!("../../stories/broken_down_at_night_in_rain.xosc")),
    ("child_between_parked_cars", include_str!("../../stories/child_between_parked_cars.xosc")),
    ("child_from_behind_bus", include_str!("../../stories/child_from_behind_bus.xosc")),
    ("cut_in_and_brakes", include_str!("../../stories/cut_in_and_brakes.xosc")),
    ("cut_out", include_str!("../../stories/cut_out.xosc")),
    ("cyclist_along_the_lane_at_night", include_str!("../../stories/cyclist_along_the_lane_at_night.xosc")),
    ("cyclist_at_the_right_turn", include_str!("../../stories/cyclist_at_the_right_turn.xosc")),
    ("cyclist_crosses", include_str!("../../stories/cyclist_crosses.xosc")),
    ("cyclist_swerves", include_str!("../../stories/cyclist_swerves.xosc")),
    ("leader_brakes", include_str!("../../stories/leader_brakes.xosc")),
    ("motorcycle_cuts_in", include_str!("../../stories/motorcycle_cuts_in.xosc")),
    ("oncoming_overtaker", include_str!("../../stories/oncoming_overtaker.xosc")),
    ("people_at_night", include_str!("../../stories/people_at_night.xosc")),
    ("pulls_out_from_the_kerb", include_str!("../../stories/pulls_out_from_the_kerb.xosc")),
    ("queue_behind_a_crest", include_str!("../../stories/queue_behind_a_crest.xosc")),
    ("red_light_runner", include_str!("../../stories/red_light_runner.xosc")),
    ("reverses_onto_the_road", include_str!("../../stories/reverses_onto_the_road.xosc")),
    ("stop_sign_runner", include_str!("../../stories/stop_sign_runner.xosc")),
    ("turns_left_across", include_str!("../../stories/turns_left_across.xosc")),
    ("wheelchair_crosses", include_str!("../../stories/wheelchair_crosses.xosc")),
    ("wrong_way_driver", include_str!("../../stories/wrong_way_driver.xosc")),
];

/// The text of a bundled story by name.
pub fn bundled_text(name: &str) -> Option<&'static str> {
    BUNDLED.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}
