//! The map in the control centre: north up, the car in the middle, what is around it, and the way.

use std::sync::Arc;

use base::chart::Chart;
use egui::epaint::PathShape;
use egui::{Color32, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2};
use glam::{Vec2 as Place, Vec3, Vec3Swizzles};
use kernel::{RoadNetwork, SceneSnapshot};
use viewers::feed::Look;

use crate::drive::traces::Traces;

const GROUND: Color32 = Color32::from_rgb(24, 27, 30);
const HOUSE: Color32 = Color32::from_rgb(44, 48, 54);
const LANE: Color32 = Color32::from_rgb(84, 90, 98);
const WAY: Color32 = Color32::from_rgb(90, 150, 220);
const ROUTE: Color32 = Color32::from_rgb(120, 220, 120);
const EGO: Color32 = Color32::from_rgb(255, 190, 60);
const VEHICLE: Color32 = Color32::from_rgb(120, 140, 255);
const PERSON: Color32 = Color32::from_rgb(255, 90, 110);
/// Width of a lane, metres.
const LANE_M: f32 = 3.4;
/// Length of the ego car as it is drawn, metres.
const EGO_M: f32 = 8.0;
/// Width of the map on the screen at first, metres.
const SPAN_M: f32 = 160.0;
const MIN_SPAN_M: f32 = 40.0;

/// The map and how much of it is seen.
pub struct MapView {
    /// The map that is driven on, drawn once.
    chart: Option<(Arc<RoadNetwork>, Chart)>,
    /// Width on the screen, metres.
    span_m: f32,
}

/// From metres to points on the screen.
struct Projection {
    middle_m: Place,
    middle: Pos2,
    points_per_m: f32,
}

impl MapView {
    /// Of no map yet.
    pub fn new() -> Self {
        Self { chart: None, span_m: SPAN_M }
    }

    /// Paints the map of what there is to see; the mouse wheel zooms.
    pub fn paint(&mut self, ui: &mut Ui, size: Vec2, look: Option<&Look>, traces: &Traces) {
        if let Some(Look { network, .. }) = look
            && self.chart.as_ref().is_none_or(|(of, _)| !Arc::ptr_eq(of, network))
        {
            self.chart = Some((network.clone(), Chart::of(network)));
        }
        let (response, painter) = ui.allocate_painter(size, Sense::hover());
        let rect = response.rect;
        painter.rect_filled(rect, 2.0, GROUND);
        let (Some((_, chart)), Some(Look { scene, .. })) = (&self.chart, look) else { return };
        let largest_m = (chart.high - chart.low).max_element();
        if response.hovered() {
            let scrolled = ui.input(|input| input.smooth_scroll_delta.y);
            self.span_m = (self.span_m * (-scrolled / 200.0).exp()).clamp(MIN_SPAN_M, largest_m.max(MIN_SPAN_M));
        }
        let middle_m = scene.ego.position.xy();
        let view = Projection { middle_m, middle: rect.center(), points_per_m: rect.width() / self.span_m };
        paint_chart(&painter, rect, &view, chart);
        view.line(&painter, &traces.way, Stroke::new(2.0, WAY));
        view.line(&painter, &traces.route, Stroke::new(3.0, ROUTE));
        paint_actors(&painter, &view, scene);
    }
}

fn paint_chart(painter: &Painter, rect: Rect, view: &Projection, chart: &Chart) {
    let lane = Stroke::new((LANE_M * view.points_per_m).max(1.0), LANE);
    for house in chart.houses.iter().filter(|house| view.meets(rect, *house)) {
        let corners = house.iter().map(|corner| view.at(*corner)).collect();
        painter.add(Shape::convex_polygon(corners, HOUSE, Stroke::NONE));
    }
    for points in chart.lanes.iter().filter(|points| view.meets(rect, points)) {
        view.line(painter, points, lane);
    }
}

fn paint_actors(painter: &Painter, view: &Projection, scene: &SceneSnapshot) {
    let ahead = |rotation: glam::Quat| (rotation * Vec3::X).xy().normalize_or(Place::X);
    for actor in &scene.actors {
        let (at, size_m) = (actor.position.xy(), actor.kind.size_m());
        if actor.kind.is_on_foot() {
            painter.circle_filled(view.at(at), (0.6 * view.points_per_m).max(2.0), PERSON);
        } else {
            let (forward, left) =
                (ahead(actor.rotation) * 0.5 * size_m.x, ahead(actor.rotation).perp() * 0.5 * size_m.y);
            view.area(
                painter,
                &[at + forward + left, at - forward + left, at - forward - left, at + forward - left],
                VEHICLE,
            );
        }
    }
    let (at, forward) = (scene.ego.position.xy(), ahead(scene.ego.rotation) * EGO_M);
    let half = 0.35 * forward.perp();
    view.area(painter, &[at + 0.65 * forward, at - 0.35 * forward + half, at - 0.35 * forward - half], EGO);
}

impl Projection {
    fn at(&self, place: Place) -> Pos2 {
        let from_middle = (place - self.middle_m) * self.points_per_m;
        self.middle + Vec2::new(from_middle.x, -from_middle.y)
    }

    /// Whether the box around some places meets a rectangle of the screen.
    fn meets(&self, rect: Rect, places: &[Place]) -> bool {
        let around = Rect::from_points(&places.iter().map(|place| self.at(*place)).collect::<Vec<_>>());
        around.expand(LANE_M * self.points_per_m).intersects(rect)
    }

    fn line(&self, painter: &Painter, places: &[Place], stroke: Stroke) {
        painter.add(PathShape::line(places.iter().map(|place| self.at(*place)).collect(), stroke));
    }

    fn area(&self, painter: &Painter, corners: &[Place], colour: Color32) {
        let corners = corners.iter().map(|corner| self.at(*corner)).collect();
        painter.add(Shape::convex_polygon(corners, colour, Stroke::NONE));
    }
}
