//! The network as a whole: what is shipped agrees with what was trained, it learns, and it goes on
//! where it was interrupted.

use burn_flex::{Flex, FlexDevice};

use super::random::Random;
use super::tape::logits;
use super::weights::Weights;
use super::*;
use crate::classes::TRAIN_CLASSES;
use crate::onnx::{Element, Engine, Output, Pixels, decode};

const WIDTH: usize = 128;
const HEIGHT: usize = 64;

/// Pictures that differ in colour as a whole and from square to square, normalised.
fn pictures(count: usize) -> Vec<f32> {
    let mut random = Random::new(&[1]);
    let mut values = Vec::new();
    for _ in 0..count {
        let whole: [f32; 3] = std::array::from_fn(|_| random.normal());
        let squares: Vec<f32> = (0..WIDTH * HEIGHT * 3 / 64).map(|_| random.normal()).collect();
        let at = |y: usize, x: usize, c: usize| whole[c] + squares[(y / 8 * (WIDTH / 8) + x / 8) * 3 + c];
        let pixels = (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (y, x)));
        values.extend(pixels.flat_map(|(y, x)| (0..3).map(move |c| at(y, x, c)).collect::<Vec<_>>()));
    }
    values
}

#[test]
fn the_shipped_network_gives_the_logits_of_the_trained_one() {
    let pictures = pictures(8);
    let mut weights = Weights::new(5);
    let (trained, moments) = logits::<Flex>(&weights, pictures.clone(), HEIGHT, WIDTH, &FlexDevice);
    weights.moments = moments;
    let bytes = export::onnx(&weights, WIDTH, HEIGHT, "{}").unwrap();
    assert_eq!(bytes, export::onnx(&weights, WIDTH, HEIGHT, "{}").unwrap());
    let engine = Engine::new(&decode(&bytes).unwrap(), None, Element::Float, [1, 3, HEIGHT, WIDTH]).unwrap();
    let classes = TRAIN_CLASSES.len();
    let positions = WIDTH / network::STRIDE * (HEIGHT / network::STRIDE);
    let spread = trained.iter().fold(0.0f32, |m, v| m.max(v.abs()));
    assert!(spread > 0.5, "logits of at most {spread} would agree by chance");
    let images = pictures.chunks_exact(WIDTH * HEIGHT * 3).zip(trained.chunks_exact(positions * classes));
    for (picture, trained) in images {
        let planes: Vec<f32> = (0..3).flat_map(|c| picture.iter().skip(c).step_by(3).copied()).collect();
        let Output::Scores(shipped) = engine.run(Pixels::Float(&planes)).unwrap() else { panic!("no scores") };
        assert_eq!(shipped.len(), trained.len());
        for (i, logit) in trained.iter().enumerate() {
            let other = shipped[i % classes * positions + i / classes];
            assert!((logit - other).abs() < 1e-3, "logit {i}: {logit} trained, {other} shipped");
        }
    }
}

#[test]
fn speed() {
    let batch = 8;
    let weights = Weights::new(1);
    let mut random = Random::new(&[1]);
    let values: Vec<f32> = (0..batch * 256 * 128 * 3).map(|_| random.normal()).collect();
    let labels: Vec<u8> = (0..batch * 256 * 128).map(|_| (random.next_u64() % 16) as u8).collect();
    let target = super::kernels::loss::Target { labels: &labels, width: 256, height: 128, weights: &[1.0; 16] };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    pool.install(|| {
        for _ in 0..10 {
            let t = std::time::Instant::now();
            let lesson = super::tape::learn::<Flex>(&weights, values.clone(), target, &FlexDevice);
            eprintln!("{} {:?}", lesson.loss, t.elapsed());
        }
    });
}
