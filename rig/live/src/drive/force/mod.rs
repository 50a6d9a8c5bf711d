//! Force feedback: what the drivers' hands feel of the car. Each seat's device is spoken to by a thread
//! of its own, to which the newest order counts; nobody waits for a device.

mod actuator;
mod effects;
#[cfg(target_os = "linux")]
mod linux;

use std::io;
use std::sync::Arc;
use std::sync::mpsc::{self, Receiver, Sender};
use std::time::Duration;

use base::newest::Newest;
use base::say;

use super::board::Message;
use actuator::Actuator;
pub use effects::Driven;
use effects::{Effects, Feel};

/// Longest wait for a device to fall silent at the end. The system ends the effects of a program that
/// is gone, but does not give it back the centring of its own.
const FAREWELL: Duration = Duration::from_millis(500);

/// What is felt at both seats.
pub struct Force {
    feel: Feel,
    /// Greatest force, [0, 1].
    limit: f32,
    is_on: bool,
    hands: Option<[Hand; 2]>,
}

/// A seat's device at a path, and what it is to do.
#[derive(Clone, Debug, Default, PartialEq)]
struct Order {
    path: Option<String>,
    effects: Effects,
}

/// The thread that speaks to a seat's device.
struct Hand {
    orders: Arc<Newest<Order>>,
    last: Order,
    silent: Receiver<()>,
}

impl Force {
    /// With a limit of 0 no device is ever touched.
    pub fn new(limit: f32, outbox: &Sender<Message>) -> Self {
        let hand = || {
            let outbox = outbox.clone();
            let say = move |text: String| {
                say::say(&text);
                // When nobody listens any more the session is over.
                let _ = outbox.send(Message::Note(text));
            };
            Hand::new(move |orders| serve(orders, open, say))
        };
        Self { feel: Feel::default(), limit, is_on: true, hands: (limit > 0.0).then(|| [hand(), hand()]) }
    }

    /// Switches it off or on.
    pub fn toggle(&mut self) {
        self.is_on = !self.is_on;
    }

    /// How it is, in words.
    pub fn words(&self) -> String {
        match (self.limit > 0.0, self.is_on) {
            (false, _) => "off by --force 0".into(),
            (true, false) => "off, F switches it on".into(),
            (true, true) => format!("{:.0} % at most, F switches it off", 100.0 * self.limit),
        }
    }

    /// What the car did in a tick is felt on the devices of those seats that have one.
    pub fn drive(&mut self, driven: &Driven<'_>, devices: [Option<&str>; 2]) {
        let effects = self.feel.tick(driven, self.limit);
        self.order(effects, devices);
    }

    /// The car does not drive: nothing is felt.
    pub fn rest(&mut self) {
        let effects = self.feel.rest();
        self.order(effects, [None, None]);
    }

    fn order(&mut self, effects: Effects, devices: [Option<&str>; 2]) {
        let is_on = self.is_on;
        for (hand, path) in self.hands.iter_mut().flatten().zip(devices) {
            hand.order(path.filter(|_| is_on), effects);
        }
    }
}

impl Hand {
    fn new(serve: impl FnOnce(&Newest<Order>) + Send + 'static) -> Self {
        let (orders, (farewell, silent)) = (Arc::new(Newest::default()), mpsc::channel());
        std::thread::spawn({
            let orders = orders.clone();
            move || {
                serve(&orders);
                drop(farewell);
            }
        });
        Self { orders, last: Order::default(), silent }
    }

    fn order(&mut self, path: Option<&str>, effects: Effects) {
        let effects = if path.is_some() { effects } else { Effects::default() };
        if self.last.path.as_deref() != path || self.last.effects != effects {
            self.last = Order { path: path.map(str::to_owned), effects };
            self.orders.put(self.last.clone());
        }
    }
}

impl Drop for Hand {
    fn drop(&mut self) {
        self.orders.close();
        // Ends with the thread, or with the wait for a device that does not answer.
        let _ = self.silent.recv_timeout(FAREWELL);
    }
}

/// What a thread knows of its device.
enum Device<A> {
    None,
    /// At this path; none when it has failed, which is said then.
    At(String, Option<A>),
}

/// Obeys the newest order until they end, and leaves the device silent.
fn serve<A: Actuator>(orders: &Newest<Order>, open: impl Fn(&str) -> io::Result<A>, say: impl Fn(String)) {
    let (mut device, mut seen) = (Device::None, 0);
    while let Some((number, order)) = orders.wait(seen) {
        seen = number;
        match (&order.path, &device) {
            (Some(path), Device::At(at, _)) if path == at => {}
            (Some(path), _) => {
                hush(&mut device);
                let opened = open(path);
                device = Device::At(path.clone(), heard(path, opened, &say));
            }
            (None, _) => hush(&mut device),
        }
        if let Device::At(path, slot) = &mut device
            && let Some(actuator) = slot
        {
            let done = actuator.apply(&order.effects);
            if heard(path, done, &say).is_none() {
                *slot = None;
            }
        }
    }
    hush(&mut device);
}

/// Ends all effects. A device that cannot do so is gone, and its effects with it.
fn hush<A: Actuator>(device: &mut Device<A>) {
    if let Device::At(_, Some(actuator)) = device {
        let _ = actuator.apply(&Effects::default());
    }
    *device = Device::None;
}

fn heard<T>(path: &str, result: io::Result<T>, say: &impl Fn(String)) -> Option<T> {
    result.map_err(|error| say(format!("no force feedback at {path}: {error}"))).ok()
}

#[cfg(target_os = "linux")]
fn open(path: &str) -> io::Result<linux::Motors> {
    linux::Motors::open(path)
}

#[cfg(not(target_os = "linux"))]
fn open(_: &str) -> io::Result<Nothing> {
    Err(io::Error::new(io::ErrorKind::Unsupported, "it is there on Linux only"))
}

/// Stands where there are no devices.
#[cfg(not(target_os = "linux"))]
enum Nothing {}

#[cfg(not(target_os = "linux"))]
impl Actuator for Nothing {
    fn apply(&mut self, _: &Effects) -> io::Result<()> {
        match *self {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A device that tells what it does, and fails when it rumbles.
    struct Told(Sender<(String, Effects)>, String);

    impl Actuator for Told {
        fn apply(&mut self, effects: &Effects) -> io::Result<()> {
            self.0.send((self.1.clone(), *effects)).expect("heard");
            if effects.rumble > 0.0 { Err(io::ErrorKind::BrokenPipe.into()) } else { Ok(()) }
        }
    }

    struct Bench {
        hand: Option<Hand>,
        done: Receiver<(String, Effects)>,
        said: Receiver<String>,
    }

    fn bench() -> Bench {
        let ((tell, done), (speak, said)) = (mpsc::channel(), mpsc::channel());
        let open = move |path: &str| match path {
            "absent" => Err(io::ErrorKind::NotFound.into()),
            path => Ok(Told(tell.clone(), path.to_owned())),
        };
        let say = move |text| speak.send(text).expect("heard");
        Bench { hand: Some(Hand::new(move |orders| serve(orders, open, say))), done, said }
    }

    impl Bench {
        fn order(&mut self, path: Option<&str>, effects: Effects) {
            self.hand.as_mut().expect("there").order(path, effects);
        }

        fn does(&self, path: &str, effects: Effects) {
            assert_eq!(self.done.recv(), Ok((path.to_owned(), effects)));
        }
    }

    const SPRING: Effects = Effects { spring: 0.25, push: 0.0, rumble: 0.0 };
    const RUMBLE: Effects = Effects { spring: 0.25, push: 0.0, rumble: 0.1 };

    #[test]
    fn a_device_is_silent_when_it_is_lost_exchanged_or_the_end_has_come() {
        let mut bench = bench();
        bench.order(Some("a"), SPRING);
        bench.does("a", SPRING);
        bench.order(None, SPRING);
        bench.does("a", Effects::default());
        bench.order(Some("a"), SPRING);
        bench.does("a", SPRING);
        bench.order(Some("b"), SPRING);
        bench.does("a", Effects::default());
        bench.does("b", SPRING);
        bench.hand = None;
        bench.does("b", Effects::default());
        assert!(bench.said.recv().is_err(), "nothing was to be said");
    }

    #[test]
    fn a_device_that_fails_falls_silent_with_one_sentence_until_it_is_back() {
        let mut bench = bench();
        bench.order(Some("a"), RUMBLE);
        bench.does("a", RUMBLE);
        assert!(bench.said.recv().expect("a sentence").starts_with("no force feedback at a: "));
        bench.order(Some("a"), SPRING);
        bench.order(None, SPRING);
        bench.order(Some("absent"), SPRING);
        assert!(bench.said.recv().expect("a sentence").starts_with("no force feedback at absent: "));
        bench.order(Some("absent"), Effects::default());
        bench.order(Some("a"), SPRING);
        bench.does("a", SPRING);
        bench.hand = None;
        bench.does("a", Effects::default());
        assert!(bench.said.recv().is_err(), "once each");
    }

    #[test]
    fn a_device_that_does_not_answer_holds_up_neither_orders_nor_the_end() {
        let (_stuck, never) = mpsc::channel::<()>();
        let mut hand = Hand::new(move |_| assert!(never.recv().is_err()));
        (1..1000).for_each(|i| hand.order(Some("a"), Effects { spring: i as f32 / 1e3, ..SPRING }));
        assert_eq!(hand.orders.get().map(|o| o.effects.spring), Some(0.999));
    }

    #[test]
    fn switched_off_or_at_rest_nothing_is_ordered() {
        let (outbox, _inbox) = mpsc::channel();
        let mut force = Force::new(0.6, &outbox);
        let last = |force: &Force| force.hands.as_ref().expect("hands").each_ref().map(|hand| hand.last.clone());
        let fast = Driven { speed_mps: 20.0, ..Driven::default() };
        // Paths that are no devices: the orders are looked at, not what becomes of them.
        force.drive(&fast, [Some("/nonexistent"), None]);
        let [semantic, safety] = last(&force);
        assert!(semantic.effects.spring > 0.1 && semantic.effects.sum() <= 0.6, "{semantic:?}");
        assert_eq!(safety, Order::default());
        force.rest();
        assert_eq!(last(&force), [Order::default(), Order::default()]);
        force.toggle();
        force.drive(&fast, [Some("/nonexistent"), None]);
        assert_eq!(last(&force), [Order::default(), Order::default()]);
        assert!(force.words().contains("F switches it on"));
        assert!(Force::new(0.0, &outbox).hands.is_none());
    }
}
