//! Work of the engine on a file that may be anything: a panic becomes an error that names the node.

use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::sync::Once;
use std::thread;

/// Stack of the thread that prepares a network, bytes: the engine follows nested expressions and graphs.
const STACK_BYTES: usize = 256 << 20;
/// Longest text of the engine's that is passed on, characters.
const LONGEST: usize = 240;

thread_local! {
    /// While guarded: the node that is worked on, or nothing yet.
    static AT: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Notes the node that is worked on; an error or panic of [`guarded`] work will name it.
pub fn note(name: &str, operator: &str) {
    AT.with_borrow_mut(|at| *at = at.is_some().then(|| node(name, operator)));
}

/// From here on no node is worked on.
pub fn note_none() {
    AT.with_borrow_mut(|at| *at = at.is_some().then(String::new));
}

/// A node in words.
pub fn node(name: &str, operator: &str) -> String {
    let is_plain = !operator.is_empty() && operator.len() < 40 && operator.bytes().all(|b| b.is_ascii_alphanumeric());
    let operator = if is_plain { operator.to_owned() } else { shown(operator) };
    format!("node {} ({operator})", shown(name))
}

/// A name of a file's as it can stand in a sentence.
pub fn shown(name: &str) -> String {
    let short: String = name.chars().take(80).collect();
    if short.len() < name.len() { format!("{short:?}...") } else { format!("{short:?}") }
}

/// A text of the engine's as one short line.
pub fn line(text: &str) -> String {
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let short: String = text.chars().take(LONGEST).collect();
    if short.len() < text.len() { format!("{short}...") } else { short }
}

/// Does the work on a thread with room on its stack.
pub fn guarded_thread<T: Send>(work: impl FnOnce() -> Result<T, String> + Send) -> Result<T, String> {
    thread::scope(|scope| {
        let thread = thread::Builder::new().stack_size(STACK_BYTES).spawn_scoped(scope, || guarded(work));
        let thread = thread.map_err(|error| format!("no thread to prepare it: {error}"))?;
        thread.join().unwrap_or_else(|panic| Err(told(panic.as_ref())))
    })
}

/// Does the work; what went wrong names the node, and panics print nothing.
pub fn guarded<T>(work: impl FnOnce() -> Result<T, String>) -> Result<T, String> {
    hush();
    AT.set(Some(String::new()));
    let result = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| Err(told(panic.as_ref())));
    let node = AT.take().unwrap_or_default();
    result.map_err(|reason| if node.is_empty() { reason } else { format!("{node}: {reason}") })
}

fn told(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
    format!("the engine cannot work with it ({})", line(text.unwrap_or("it gives no reason")))
}

/// Panics of guarded work print nothing; all others are told as before.
fn hush() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let before = take_hook();
        set_hook(Box::new(move |info| {
            if AT.with_borrow(Option::is_none) {
                before(info);
            }
        }));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panics_and_errors_name_the_node() {
        let panicking = || -> Result<(), String> {
            note("a\nb", "Conv");
            panic!("no\nroom")
        };
        let said = "node \"a\\nb\" (Conv): the engine cannot work with it (no room)";
        assert_eq!(guarded(panicking).unwrap_err(), said);
        assert_eq!(guarded_thread(panicking).unwrap_err(), said);
        let failing = || -> Result<(), String> {
            note("a", "Conv");
            note_none();
            Err("no room".into())
        };
        assert_eq!(guarded(failing).unwrap_err(), "no room");
        assert_eq!(guarded(|| Ok(7)), Ok(7));
    }
}
