//! Pictures to look at.

/// A picture with areas and soft borders: the mean of noise on grids of 4x2 to 64x32 cells; 3 bytes a pixel.
pub fn picture(width: usize, height: usize, seed: u64) -> Vec<u8> {
    let mut random = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 5;
    let mut noise = || {
        random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (random >> 40) as f32 / (1u64 << 24) as f32
    };
    let mut planes = [const { Vec::new() }; 3];
    for plane in &mut planes {
        *plane = vec![0.0; width * height];
        for k in 1..=5 {
            let (cols, rows) = (2 << k, 1 << k);
            let cells: Vec<f32> = (0..cols * rows).map(|_| noise()).collect();
            let fine = upsampled(&cells, (cols, rows), (width, height));
            plane.iter_mut().zip(fine).for_each(|(sum, value)| *sum += value / 5.0);
        }
    }
    let byte = |value: f32| (((value - 0.5) * 2.0 + 0.5).clamp(0.0, 1.0) * 255.0) as u8;
    (0..width * height).flat_map(|pixel| planes.each_ref().map(|plane| byte(plane[pixel]))).collect()
}

/// A plane of one size (columns, rows) in another one: bilinear, half-pixel centres.
pub fn upsampled(plane: &[f32], from: (usize, usize), to: (usize, usize)) -> Vec<f32> {
    let (across, down) = (places(from.0, to.0), places(from.1, to.1));
    let mut out = Vec::with_capacity(to.0 * to.1);
    for (top, share) in down {
        let bottom = (top + 1).min(from.1 - 1);
        let mixed = |x: usize| plane[top * from.0 + x] * (1.0 - share) + plane[bottom * from.0 + x] * share;
        let row: Vec<f32> = (0..from.0).map(mixed).collect();
        out.extend(across.iter().map(|&(left, share)| {
            let right = (left + 1).min(from.0 - 1);
            row[left] * (1.0 - share) + row[right] * share
        }));
    }
    out
}

/// Where each of so many new places lies between old ones: the one before it, and the share of the next.
fn places(from: usize, to: usize) -> Vec<(usize, f32)> {
    let place = |i: usize| ((i as f32 + 0.5) * from as f32 / to as f32 - 0.5).clamp(0.0, (from - 1) as f32);
    (0..to).map(place).map(|place| (place as usize, place.fract())).collect()
}
