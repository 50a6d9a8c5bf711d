//! Which moment shows a hazard best, and the strip.

use glam::{Quat, Vec3};
use kernel::RoadNetwork;
use kernel::scene::ActorKind;
use render::{AdapterChoice, Camera, EGO_INSTANCE, Frame, Mount, Quality, Renderer, instance_of_actor};

use super::caption;
use super::drive::Film;
use super::moments::Moment;
use super::shots::{PICTURES, Shot};

const WIDTH: u32 = 272;
const HEIGHT: u32 = 176;
const GAP_PX: u32 = 3;
/// Whoever is named has at least so many pixels in every picture.
const LEAST_PX: usize = 60;
/// More pixels than these make no moment better.
const ENOUGH_PX: usize = 900;
/// At most so many moments are looked at.
const MOST_MOMENTS: usize = 60;

/// What draws.
pub struct Studio(Renderer);

impl Studio {
    pub fn new(network: &RoadNetwork) -> anyhow::Result<Self> {
        Ok(Self(Renderer::new(network, &AdapterChoice::default())?))
    }

    /// The moment in whose pictures most is to be seen of those that it is about.
    pub fn best(&mut self, shot: &Shot, film: &Film, moments: Vec<Moment>) -> anyhow::Result<Option<Moment>> {
        let mut best: Option<(usize, Moment)> = None;
        let step = moments.len().div_ceil(MOST_MOMENTS).max(1);
        for moment in moments.into_iter().step_by(step) {
            let score = self.score(shot, film, &moment)?;
            if score > best.map_or(0, |(most, _)| most) {
                best = Some((score, moment));
            }
        }
        Ok(best.map(|(_, moment)| moment))
    }

    /// Pixels of the one that is seen least in the picture where it is seen least; 0 if that is not enough.
    fn score(&mut self, shot: &Shot, film: &Film, moment: &Moment) -> anyhow::Result<usize> {
        let mut least = ENOUGH_PX;
        for time_s in shot.times_s {
            let Some(frame) = self.picture(shot, film, moment, time_s)? else { return Ok(0) };
            let pixels = |instance: u16| frame.instance_ids.iter().filter(|id| **id == instance).count();
            let named = [Some(moment.who), moment.ahead].into_iter().flatten();
            least = named.map(|id| pixels(instance_of_actor(id))).fold(least, usize::min);
            if shot.others {
                let at = film.after(moment.at, time_s).unwrap_or_default();
                least = least.min(behind(film, at, moment.who).map(pixels).max().unwrap_or(0));
            }
            if least < LEAST_PX {
                return Ok(0);
            }
        }
        Ok(least)
    }

    /// One picture of a strip, if the drive goes so far and the one whom it is about is there.
    fn picture(&mut self, shot: &Shot, film: &Film, moment: &Moment, time_s: f32) -> anyhow::Result<Option<Frame>> {
        let Some(at) = film.after(moment.at, time_s) else { return Ok(None) };
        let Some(camera) = camera(shot, film, moment, at) else { return Ok(None) };
        Ok(Some(self.0.draw(&film.scenes[at], &camera)?))
    }

    /// The pictures of a moment side by side, each with its time and the speed of the one whom it is about.
    pub fn strip(&mut self, shot: &Shot, film: &Film, moment: &Moment) -> anyhow::Result<((u32, u32), Vec<u8>)> {
        let size = ((WIDTH + GAP_PX) * PICTURES as u32 - GAP_PX, HEIGHT);
        let mut rgb = vec![255; (size.0 * size.1 * 3) as usize];
        for (i, time_s) in shot.times_s.into_iter().enumerate() {
            let Some(mut frame) = self.picture(shot, film, moment, time_s)? else { continue };
            let kmh =
                film.after(moment.at, time_s).and_then(|at| film.actor(at, moment.who)).map(|a| 3.6 * a.speed_mps);
            let speed = kmh.filter(|_| moment.who < kernel::scene::FIRST_DOOR_ID);
            let speed = speed.map_or(String::new(), |kmh| format!("  {:.0} km/h", kmh.abs()));
            caption::mark(&mut frame, instance_of_actor(moment.who));
            caption::write(&mut frame, &format!("{:.1} s{speed}", time_s - shot.times_s[0]));
            for (y, row) in frame.rgb.chunks_exact(3 * WIDTH as usize).enumerate() {
                let start = 3 * (y * size.0 as usize + i * (WIDTH + GAP_PX) as usize);
                rgb[start..start + row.len()].copy_from_slice(row);
            }
        }
        Ok((size, rgb))
    }
}

/// Instances of those who drive up to 17 m behind somebody, the ego car too.
fn behind(film: &Film, at: usize, who: u32) -> impl Iterator<Item = u16> {
    let scene = &film.scenes[at];
    let of = film.actor(at, who).copied();
    let near = move |position: Vec3, rotation: Quat| {
        of.is_some_and(|of| {
            let (to, forward) = (position - of.position, of.rotation * Vec3::X);
            to.length() < 17.0 && to.dot(forward) < -3.0 && (rotation * Vec3::X).dot(forward) > 0.9
        })
    };
    let drives = ActorKind::is_vehicle;
    let others = scene.actors.iter().filter(move |a| drives(a.kind) && near(a.position, a.rotation));
    let ego = near(scene.ego.position, scene.ego.rotation).then_some(EGO_INSTANCE);
    others.map(|a| instance_of_actor(a.id)).chain(ego)
}

/// The camera of a picture.
fn camera(shot: &Shot, film: &Film, moment: &Moment, at: usize) -> Option<Camera> {
    let start = film.actor(moment.at, moment.who)?;
    let now = film.actor(at, moment.who)?;
    let anchor = if shot.stays { start } else { now };
    // The direction at the moment, so that turning is seen.
    let place = |[x, y, z]: [f32; 3]| anchor.position + start.rotation * Vec3::new(x, y, 0.0) + Vec3::Z * z;
    let (position, target) = (place(shot.from_m), place(shot.to_m));
    let way = target - position;
    let (yaw_rad, pitch_rad) = (way.y.atan2(way.x), -way.z.atan2(way.truncate().length()));
    let rotation = Quat::from_rotation_z(yaw_rad) * Quat::from_rotation_y(pitch_rad);
    Some(Camera {
        mount: Mount::World,
        position,
        rotation,
        fov_x_rad: shot.fov_deg.to_radians(),
        width: WIDTH,
        height: HEIGHT,
        quality: Quality::Fine,
        sensor: Default::default(),
        models: None,
    })
}
