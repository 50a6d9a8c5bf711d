//! What the parser says of a file, in groups.

use super::notes::{Notes, Passed};

/// Notes every warning of the parser, which tells the place itself.
pub(super) fn note(warnings: &[xodr::Warning], notes: &mut Notes) {
    use xodr::Warning as W;
    for warning in warnings {
        let (name, count) = match warning {
            W::Ignored { feature, count, .. } => (Some(format!("ignored: {feature}")), *count),
            W::NewerThanDeclared { feature, count, .. } => {
                (Some(format!("newer than the version of the file: {feature}")), *count)
            }
            _ => (None, 1),
        };
        notes.pass_all(count, kind(warning), "", || name.unwrap_or_else(|| words(warning)), || warning.to_string());
    }
}

/// Whether something is missing that is referred to, or anything else is wrong.
fn kind(warning: &xodr::Warning) -> Passed {
    use xodr::Warning as W;
    match warning {
        W::SignalLinkDropped { .. }
        | W::LaneLinkDropped { .. }
        | W::ConnectionDropped { .. }
        | W::JunctionLinkMissing { .. }
        | W::LinkGap { .. }
        | W::NeighborDropped { .. }
        | W::PriorityDropped { .. }
        | W::JunctionReferenceDropped { .. }
        | W::CrossPathDropped { .. }
        | W::VirtualJunctionWithoutMainRoad { .. }
        | W::VirtualLinkDropped { .. }
        | W::VirtualLaneDropped { .. }
        | W::RoadSectionDropped { .. }
        | W::IncludeDropped { .. } => Passed::Reference,
        _ => Passed::Warning,
    }
}

/// The name of a kind of warning as words: the parser gives its kinds no others.
fn words(warning: &xodr::Warning) -> String {
    let debug = format!("{warning:?}");
    let mut words = String::new();
    for (k, c) in debug.chars().take_while(|c| c.is_ascii_alphanumeric()).enumerate() {
        if c.is_ascii_uppercase() && k > 0 {
            words.push(' ');
        }
        words.push(c.to_ascii_lowercase());
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warnings_of_a_kind_are_one_group() {
        let at = |s: f64| xodr::Warning::ShapeShortOfRoad { road_id: "7".into(), s };
        let ignored = |count| xodr::Warning::Ignored {
            road_id: "7".into(),
            junction_id: String::new(),
            feature: "<x>".into(),
            count,
        };
        let missing = xodr::Warning::PriorityDropped {
            junction_id: "3".into(),
            high: "1".into(),
            low: "2".into(),
            road_id: "2".into(),
        };
        let mut notes = Notes::wanted();
        note(&[at(1.0), at(2.0), ignored(3), ignored(4), missing], &mut notes);
        let told: Vec<_> = notes.finish().into_iter().map(|g| (g.kind, g.what, g.count)).collect();
        let expected = [
            (Passed::Warning, "ignored: <x>", 7),
            (Passed::Warning, "shape short of road", 2),
            (Passed::Reference, "priority dropped", 1),
        ];
        assert_eq!(told, expected.map(|(kind, what, count)| (kind, what.to_owned(), count)));
    }
}
