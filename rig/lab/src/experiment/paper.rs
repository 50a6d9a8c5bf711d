//! What the paper found (Kowol, Bracke and Gottschalk 2022), beside which our figures stand.

/// A row of its Table 1, in the order of [`super::set::Set::ALL`]: pedestrian pixels a scene; IoU of pedestrians
/// and mean IoU on safety-critical frames; the same on natural ones.
pub const TABLE_1: [[f64; 5]; 3] = [
    [3583.6, 0.4600, 0.6954, 0.4937, 0.7610],
    [6101.1, 0.5399, 0.6911, 0.5586, 0.7554],
    [6215.7, 0.5683, 0.7173, 0.5384, 0.7517],
];

/// A row of its Table 2: kilometres, minutes, corner cases, kilometres for each (mean and standard
/// deviation), minutes for each.
pub const TABLE_2: [[f64; 7]; 3] = [
    [121.32, 411.0, 13.0, 7.73, 14.25, 25.93, 39.60],
    [163.09, 500.0, 21.0, 7.52, 10.47, 23.25, 28.72],
    [153.38, 528.0, 11.0, 13.84, 8.68, 47.47, 31.87],
];
