//! Names that become parts of paths.

/// Longest name, bytes: with an ending it still fits what file systems take.
const LONGEST: usize = 100;

/// Refuses a name that cannot be the name of a file, or would be one elsewhere or hidden: the error says what
/// was expected.
pub fn check_name(name: &str) -> Result<(), String> {
    let is_odd = |c: char| c.is_control() || matches!(c, '/' | '\\');
    if name.is_empty() || name.len() > LONGEST || name.starts_with('.') || name.contains(is_odd) {
        let shown: String = name.chars().take(LONGEST).collect();
        return Err(format!(
            "the name {shown:?} cannot be a file's; expected 1 to {LONGEST} bytes without / and \\ that begin with no dot"
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_lead_elsewhere_are_refused() {
        for name in ["city", "Köln Süd (2)", "a.b", "x-1_2"] {
            assert_eq!(check_name(name), Ok(()));
        }
        let long = "x".repeat(LONGEST + 1);
        for name in ["", ".", "..", ".a", "../../x", "a/b", "/a", "a\\b", "a\0b", "a\nb", &long] {
            assert!(check_name(name).unwrap_err().contains("cannot be a file's"), "{name:?}");
        }
    }
}
