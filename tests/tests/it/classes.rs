//! The class tables of `render` and `perception`, which do not know each other, are one.

use perception::classes::{TAGS, tag_name, tag_of_name};
use render::tags;

#[test]
fn both_crates_mean_the_same_by_an_id() {
    assert_eq!(tags::TAG_COUNT, TAGS);
    for tag in tags::TAGS {
        let id = *tag as u8;
        assert_eq!(tag_name(id), Some(tag.name()));
        assert_eq!(tag_of_name(tag.name()), Some(id));
    }
}

#[test]
fn finer_tags_and_class_names_of_other_schemes_agree() {
    for tag in &render::SemanticTag::ALL[tags::TAG_COUNT..] {
        assert_eq!(tag_of_name(tag.name()), Some(tag.coarse() as u8), "{}", tag.name());
    }
}
