//! The live rig: two people, or bots, at two screens, one car, and a control centre.
//!
//! The simulation paces itself by the clock and waits for nobody: views are drawn, predicted and
//! painted by other threads, of which the newest result wins.

mod aftermath;
mod board;
mod disk;
mod eyes;
mod hud;
mod pacing;
mod run;
mod simulation;
mod stage;
mod windows;

use std::sync::Arc;
use std::sync::mpsc::{self, Sender};

use anyhow::anyhow;
use kernel::{Scenario, World};
use replay::Provenance;

use crate::cli::DriveArgs;
use crate::clock::SessionClock;
use crate::exit::Verdict;
use crate::maps::Map;
use crate::progress::Interrupt;
use crate::vision::Eye;
use board::{Board, Message, Wake};
use simulation::{Links, Plan, Simulation};
use windows::{Waker, Windows};

/// Size of the safety driver's picture, pixels.
const SAFETY_SIZE: (u32, u32) = (640, 360);

/// Runs `aeye drive` with windows.
pub fn drive(args: &DriveArgs, scenario: Scenario, map: Map, json: bool) -> anyhow::Result<Verdict> {
    let windows = Windows::new()?;
    World::new(&scenario, &map.network)?;
    let eye = Eye::open(&args.checkpoint)?;
    let renderers = [eyes::renderer(&map.network)?, eyes::renderer(&map.network)?];
    let seats = [args.semantic.clone(), args.safety.clone()].map(Option::unwrap_or_default);

    let (outbox, inbox) = mpsc::channel();
    let (board, clock) = (Arc::new(Board::default()), SessionClock::starting_now());
    let waker = windows.waker();
    let wake = waker.clone();
    let links = Links {
        board: board.clone(),
        inbox,
        outbox: outbox.clone(),
        wake: Box::new(move |what| wake.wake(what)),
        clock,
        interrupt: Interrupt::listen()?,
    };
    let provenance = provenance(&eye);
    let plan = Plan { map, scenario, seats, record: args.record.clone(), provenance, json };
    let simulation = Simulation::new(plan, links, eye.name())?;

    let [safety_renderer, semantic_renderer] = renderers;
    std::thread::scope(|scope| {
        scope.spawn({
            let (board, waker, outbox) = (&*board, waker.clone(), outbox.clone());
            let show = {
                let waker = waker.clone();
                move || waker.wake(Wake::Safety)
            };
            move || report(&outbox, eyes::watch_as_safety(board, safety_renderer, SAFETY_SIZE, clock, show))
        });
        scope.spawn({
            let (board, waker, outbox) = (&*board, waker.clone(), outbox.clone());
            let show = move || waker.wake(Wake::Semantic);
            move || report(&outbox, eyes::watch_as_semantic(board, semantic_renderer, eye, clock, show))
        });
        let driving = scope.spawn(move || {
            let _over = Over(waker);
            simulation.drive()
        });
        let shown = windows.show(board.clone(), outbox.clone(), clock);
        // The windows are gone, by the simulation's word or by a failure of their own.
        let _ = outbox.send(Message::Closed);
        let driven = driving.join().unwrap_or_else(|_| Err(anyhow!("the simulation thread panicked")));
        board.scene.close();
        driven.and(shown)
    })?;
    Ok(Verdict::Ok)
}

/// Tells the simulation when an eye cannot go on; a simulation that is over needs no eyes.
fn report(outbox: &Sender<Message>, result: anyhow::Result<()>) {
    if let Err(error) = result {
        let _ = outbox.send(Message::Failed(error));
    }
}

/// Ends the windows when the simulation ends, however it does.
struct Over(Waker);

impl Drop for Over {
    fn drop(&mut self) {
        self.0.wake(Wake::Over);
    }
}

/// What the recordings say about the semantic driver's eye.
fn provenance(eye: &Eye) -> Provenance {
    let (width, height) = eye.size();
    let entries = [
        ("checkpoint", eye.name().to_owned()),
        ("checkpoint_digest", eye.digest()),
        ("camera", format!("driver {width}x{height}")),
        ("live", "true".to_owned()),
    ];
    entries.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}
