//! Leaves out triangles of which no sample of a picture shows anything, before they reach a software renderer: those
//! turned away, those beside the picture, those that slip between its samples (Wihlidal 2016, "Optimizing the graphics
//! pipeline with compute") and those behind others (a depth buffer of the processor's own, as of Collin 2011, "Culling the
//! Battlefield"). Such a renderer spends most of its time on a triangle before it finds that out. What is left draws the same
//! picture, bit by bit.

mod grid;

use glam::{Vec2, Vec3};
use kernel::SceneSnapshot;

use crate::mesh::{FINISHES, Finish, Vertex};
use crate::view::View;
use crate::wind::Gusts;
use grid::{Grid, Look, NEAREST, Place, Surface};

/// Which list a triangle is drawn from: what moves, or what stands still for each finish.
pub(crate) const LISTS: usize = FINISHES + 1;
/// That of what moves.
pub(crate) const MOVING: usize = FINISHES;

/// Of pixels' middles and of their corners.
const MOST_GRIDS: usize = 2;

/// Indices of triangles, list by list.
pub(crate) type Lists = [Vec<u32>; LISTS];

/// A triangle's indices and places.
type Kept = ([u32; 3], [Place; 3]);

/// What a picture shows of triangles.
#[derive(Default)]
pub(crate) struct Sieve {
    eye: Vec3,
    ahead: Vec3,
    /// Samples to the right and downwards of the middle of the picture for what is one metre ahead.
    right: Vec3,
    down: Vec3,
    middle: Vec2,
    /// Of the wind at the tick of the picture.
    gusts: Gusts,
    /// Everything is kept.
    keeps_all: bool,
    /// Of pixels' middles and, where they are drawn, of their corners.
    grids: Vec<Grid>,
    /// What may be seen so far, for each grid, with places in the picture.
    kept: Vec<[Vec<Kept>; LISTS]>,
    /// What is kept of everything.
    all: Lists,
    /// The vertices of the mesh at hand.
    places: Vec<Place>,
}

impl Sieve {
    /// Begins a picture of so many samples of a view, and as many corners and one more each way; `keeps_all` leaves nothing out.
    pub(crate) fn begin(&mut self, view: &View, size: [u32; 2], corners: bool, scene: &SceneSnapshot, keeps_all: bool) {
        self.middle = 0.5 * Vec2::new(size[0] as f32, size[1] as f32);
        (self.eye, self.ahead) = (view.eye, view.ahead);
        self.right = view.right * (self.middle.x / view.tan_x);
        self.down = view.up * (-self.middle.y / view.tan_y);
        self.gusts = Gusts::new(&scene.weather, scene.tick);
        self.keeps_all = keeps_all;
        self.all.iter_mut().for_each(Vec::clear);
        self.grids.resize_with(if keeps_all { 0 } else { 1 + usize::from(corners) }, Grid::default);
        self.kept.resize_with(self.grids.len(), Default::default);
        self.kept.iter_mut().flatten().for_each(Vec::clear);
        for (i, grid) in (0..).zip(&mut self.grids) {
            grid.begin(size.map(|side| side + i), 0.5 * i as f32);
        }
    }

    /// Whether any sample may show something of what lies in a box, given by two corners: cells of the ground far away lie
    /// between two rows, others behind houses.
    pub(crate) fn may_show_of(&self, extent: [Vec3; 2]) -> bool {
        let corner = |i: usize| Vec3::new(extent[i & 1].x, extent[i >> 1 & 1].y, extent[i >> 2].z);
        let mut reach = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for place in (0..8).map(|i| self.place_of(corner(i))) {
            if self.keeps_all || !(0.0..NEAREST).contains(&place.z) {
                return true;
            }
            reach = (reach.0.min(place), reach.1.max(place));
        }
        let (low, high) = (reach.0.truncate(), reach.1.truncate());
        self.grids.iter().any(|grid| grid.may_show_between(low, high, reach.1.z))
    }

    /// Takes the triangles of a mesh that may be seen, nearer meshes best first. `first` is the index of its first vertex; lists of
    /// indices come with their number.
    pub(crate) fn sift<'a>(
        &mut self,
        vertices: &[Vertex],
        first: u32,
        lists: impl Iterator<Item = (usize, &'a [u32])>,
    ) {
        if !self.keeps_all {
            self.place(vertices);
        }
        for (list, indices) in lists {
            if self.keeps_all {
                self.all[list].extend_from_slice(indices);
                continue;
            }
            for &triangle in indices.as_chunks::<3>().0 {
                let corners = triangle.map(|i| self.places[(i - first) as usize]);
                self.cover(list, triangle, corners);
            }
        }
    }

    /// What pixels' middles may see when everything is known that may hide something.
    pub(crate) fn seen(&self) -> Lists {
        self.seen_by(0)
    }

    /// The same of pixels' corners, of what is nearer to them than some places are, row by row, 1 over metres ahead of the eye.
    pub(crate) fn seen_by_corners(&mut self, known: impl Iterator<Item = f32>) -> Lists {
        if let Some(grid) = self.grids.get_mut(1) {
            grid.raise(known);
        }
        self.seen_by(1)
    }

    fn seen_by(&self, number: usize) -> Lists {
        let (Some(grid), Some(kept)) = (self.grids.get(number), self.kept.get(number)) else {
            return self.all.clone();
        };
        let may_show = |corners: [Place; 3]| match Look::at(corners) {
            Look::Unseen => false,
            Look::Crossing => true,
            Look::Facing(outline) => {
                grid.around(&outline).is_some_and(|samples| grid.may_show(&Surface::of(&outline), &samples))
            }
        };
        let seen = |list: usize| kept[list].iter().filter(|kept| may_show(kept.1)).flat_map(|kept| kept.0);
        core::array::from_fn(|list| seen(list).collect())
    }

    #[inline]
    fn cover(&mut self, list: usize, triangle: [u32; 3], corners: [Place; 3]) {
        let outline = match Look::at(corners) {
            Look::Unseen => return,
            Look::Crossing => {
                self.kept.iter_mut().for_each(|kept| kept[list].push((triangle, corners)));
                return;
            }
            Look::Facing(outline) => outline,
        };
        let around = core::array::from_fn(|i| self.grids.get(i).and_then(|grid| grid.around(&outline)));
        if around == [const { None }; MOST_GRIDS] {
            return;
        }
        let surface = Surface::of(&outline);
        // Between leaves one sees what lies behind.
        let has_holes = Finish::ALL.get(list).is_some_and(|finish| finish.has_holes());
        for ((grid, kept), around) in self.grids.iter_mut().zip(&mut self.kept).zip(&around) {
            let may_show =
                |samples| if has_holes { grid.may_show(&surface, samples) } else { grid.cover(&surface, samples) };
            if around.as_ref().is_some_and(may_show) {
                kept[list].push((triangle, corners));
            }
        }
    }

    fn place(&mut self, vertices: &[Vertex]) {
        let offset = |v: &Vertex, at: Vec3| {
            let share = f32::from(v.sway) / 127.0;
            (share * self.gusts.offset(at.truncate())).extend(0.0)
        };
        let mut kept = core::mem::take(&mut self.places);
        kept.clear();
        kept.extend(vertices.iter().map(|v| {
            let at = Vec3::from_array(v.position);
            self.place_of(if v.sway == 0 { at } else { at + offset(v, at) })
        }));
        self.places = kept;
    }

    fn place_of(&self, at: Vec3) -> Place {
        let rel = at - self.eye;
        let nearness = 1.0 / rel.dot(self.ahead);
        let place = self.middle + Vec2::new(rel.dot(self.right), rel.dot(self.down)) * nearness;
        place.extend(nearness)
    }
}
