//! A layout for Foxglove and Lichtblick that shows an export: scene, pictures, plots, log.

use serde_json::{Map, Value, json};
use viewers::boxes::EGO;
use viewers::messages::topics::{
    ACTORS, CALIBRATION, CRITICALITY, EVENTS, GROUND, PATH, RGB, TELEMETRY, TRUTH, calibration_of, predicted, rgb_of,
};

/// The layout for exports with masks of these checkpoints, and pictures of these cameras beside the drivers'.
pub fn layout<'a>(checkpoints: impl Iterator<Item = &'a str>, cameras: impl Iterator<Item = &'a str>) -> Value {
    let masks: Vec<String> = std::iter::once(TRUTH.to_owned()).chain(checkpoints.map(predicted)).collect();
    let mut panels = Map::new();
    panels.insert("3D!scene".into(), scene());
    panels.insert("Image!camera".into(), image(RGB, CALIBRATION));
    panels.insert("RosOut!events".into(), json!({ "searchTerms": [], "minLogLevel": 1, "topicToRender": EVENTS }));
    panels.insert("StateTransitions!control".into(), states(&["phase", "steering_by", "pedals_by"]));
    panels.insert("Plot!speed".into(), plot(TELEMETRY, &["speed_mps", "limit_mps"]));
    panels
        .insert("Plot!pedals".into(), plot(TELEMETRY, &["throttle", "brake", "steer", "safety_brake", "safety_steer"]));
    let critical = ["ttc_s", "pret_s", "required_deceleration_mps2"];
    panels.insert("Plot!criticality".into(), plot(CRITICALITY, &critical));
    let masks = masks.into_iter().map(|topic| (topic, CALIBRATION.to_owned()));
    let others = cameras.map(|camera| (rgb_of(camera), calibration_of(camera)));
    let masks = masks.chain(others).map(|(topic, calibration)| {
        let id = format!("Image!{}", topic.trim_start_matches('/').replace('/', "."));
        panels.insert(id.clone(), image(&topic, &calibration));
        json!(id)
    });
    let masks = stacked(masks.collect());
    let pictures = split("column", json!("Image!camera"), masks, 35);
    let figures =
        stacked(["StateTransitions!control", "Plot!speed", "Plot!pedals", "Plot!criticality"].map(Value::from).into());
    let world = split("column", json!("3D!scene"), json!("RosOut!events"), 75);
    let layout = split("row", split("row", world, pictures, 55), figures, 70);
    json!({
        "configById": panels, "globalVariables": {}, "userNodes": {}, "playbackConfig": { "speed": 1 },
        "layout": layout,
    })
}

fn split(direction: &str, first: Value, second: Value, percent: u32) -> Value {
    json!({ "direction": direction, "first": first, "second": second, "splitPercentage": percent })
}

/// Panels one below the other, each as high as the others.
fn stacked(mut panels: Vec<Value>) -> Value {
    let mut below = panels.pop().unwrap_or_default();
    for (more, panel) in (2..).zip(panels.into_iter().rev()) {
        below = split("column", panel, below, 100 / more);
    }
    below
}

fn scene() -> Value {
    let visible = |topics: &[&str]| -> Map<String, Value> {
        topics.iter().map(|topic| ((*topic).to_owned(), json!({ "visible": true }))).collect()
    };
    json!({
        "followMode": "follow-pose", "followTf": EGO,
        "cameraState": {
            "perspective": true, "distance": 45, "phi": 60, "thetaOffset": 90, "fovy": 45, "near": 0.5, "far": 5000,
            "target": [0, 0, 0], "targetOffset": [0, 0, 0], "targetOrientation": [0, 0, 0, 1],
        },
        "scene": { "transforms": { "showLabel": false, "axisScale": 0, "editable": false } },
        "transforms": {}, "topics": visible(&[GROUND, ACTORS, PATH]), "layers": {},
    })
}

fn image(topic: &str, calibration: &str) -> Value {
    json!({ "imageMode": { "imageTopic": topic, "calibrationTopic": calibration } })
}

fn figure(topic: &str, name: &str) -> Value {
    json!({ "value": format!("{topic}.{name}"), "label": name, "enabled": true, "timestampMethod": "receiveTime" })
}

fn plot(topic: &str, names: &[&str]) -> Value {
    json!({
        "paths": names.iter().map(|name| figure(topic, name)).collect::<Vec<_>>(), "xAxisVal": "timestamp",
        "showXAxisLabels": true, "showYAxisLabels": true, "showLegend": true, "legendDisplay": "floating",
        "isSynced": true, "sidebarDimension": 240,
    })
}

fn states(names: &[&str]) -> Value {
    json!({ "paths": names.iter().map(|name| figure(TELEMETRY, name)).collect::<Vec<_>>(), "isSynced": true })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leaves<'a>(node: &'a Value, found: &mut Vec<&'a str>) {
        match node.as_str() {
            Some(panel) => found.push(panel),
            None => ["first", "second"].iter().for_each(|side| leaves(&node[side], found)),
        }
    }

    #[test]
    fn every_panel_has_its_place() {
        let layout = layout(["early", "full"].into_iter(), ["left"].into_iter());
        let mut placed = Vec::new();
        leaves(&layout["layout"], &mut placed);
        placed.sort_unstable();
        let panels: Vec<&String> = layout["configById"].as_object().expect("panels").keys().collect();
        assert_eq!(placed, panels);
        assert!(placed.contains(&"Image!camera.predicted.full"));
        let left = &layout["configById"]["Image!cameras.left.rgb"]["imageMode"];
        assert_eq!(left["calibrationTopic"], "/cameras/left/calibration");
    }
}
