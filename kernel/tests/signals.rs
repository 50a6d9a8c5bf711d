//! Signal programmes of real towns.
#![allow(clippy::disallowed_methods, reason = "tests may read files")]

#[path = "common/programmes.rs"]
mod programmes;

use std::path::Path;

use kernel::map::bake;
use programmes::check_programmes;

/// Where the real maps are, the controllers of each junction are its phases.
#[test]
fn controllers_of_real_towns_are_phases() {
    let roots = ["../../shared/maps", "../../../shared/maps"].map(Path::new);
    let Some(root) = roots.into_iter().find(|root| root.is_dir()) else { return };
    for (town, junctions) in [("Town01", 12), ("Town02", 8), ("Town06", 8)] {
        let text = std::fs::read_to_string(root.join(format!("{town}.xodr"))).unwrap();
        let map = bake(town, &text).unwrap();
        check_programmes(&map);
        let lit = map.junctions.iter().filter(|j| !j.light_groups.is_empty());
        assert_eq!(lit.clone().count(), junctions, "{town}");
        for junction in lit {
            let mut starts: Vec<_> =
                junction.light_groups.iter().map(|g| map.light_groups[*g as usize].green_from_ticks).collect();
            assert!(starts.is_sorted(), "{town}, {}: in the order of the file", junction.name);
            starts.dedup();
            let file = text.split(&format!("<junction id=\"{}\"", junction.name)).nth(1).unwrap();
            let controllers = file.split("</junction>").next().unwrap().matches("<controller ").count();
            assert!(starts.len() == controllers, "{town}, {}: {starts:?} of {controllers}", junction.name);
        }
    }
}
