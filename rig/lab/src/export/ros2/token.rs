//! Names as ROS 2 has them.

/// A name as a part of a topic, which has letters, digits and underscores, and no digit first.
pub(super) fn token(name: &str) -> String {
    let allowed: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if allowed.starts_with(|c: char| c.is_ascii_digit()) { format!("n{allowed}") } else { allowed }
}
