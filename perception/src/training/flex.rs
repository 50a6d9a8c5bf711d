//! The kernels on burn's CPU backend.

use burn_backend::tensor::FloatTensor;
use burn_backend::{TensorData, TensorMetadata};
use burn_flex::{Flex, FlexTensor};

use super::kernels::depthwise::{self, Geometry};
use super::kernels::loss::{self, Target};
use super::kernels::norm;
use super::kernels::patches::patches;
use super::network::Size;
use super::tape::{Kernels, Norm};
use super::weights::Moments;

/// Calls back with the numbers of a tensor, which are copied only where they are not in order.
fn with<R>(tensor: &FlexTensor, work: impl FnOnce(&[f32]) -> R) -> R {
    match tensor.as_slice() {
        Some(values) => work(values),
        None => work(tensor.to_contiguous().storage()),
    }
}

fn tensor(values: Vec<f32>, cols: usize) -> FlexTensor {
    let rows = values.len() / cols;
    FlexTensor::from_data(TensorData::new(values, [rows, cols]))
}

fn cols(tensor: &FlexTensor) -> usize {
    tensor.shape()[1]
}

impl Kernels for Flex {
    fn read(tensor: &FloatTensor<Self>) -> Vec<f32> {
        with(tensor, <[f32]>::to_vec)
    }

    fn patches(images: &FloatTensor<Self>, size: Size) -> FloatTensor<Self> {
        tensor(with(images, |images| patches(images, size)), 9 * size.channels)
    }

    fn depthwise(x: &FloatTensor<Self>, weights: &FloatTensor<Self>, geometry: Geometry) -> FloatTensor<Self> {
        let y = with(x, |x| with(weights, |weights| depthwise::forward(x, weights, geometry)));
        tensor(y, geometry.input.channels)
    }

    fn depthwise_backward(
        x: &FloatTensor<Self>,
        weights: &FloatTensor<Self>,
        dy: &FloatTensor<Self>,
        geometry: Geometry,
    ) -> [FloatTensor<Self>; 2] {
        let run = |x: &[f32], weights: &[f32], dy: &[f32]| depthwise::backward(x, weights, dy, geometry);
        let (dx, dw) = with(x, |x| with(weights, |weights| with(dy, |dy| run(x, weights, dy))));
        [dx, dw].map(|values| tensor(values, geometry.input.channels))
    }

    fn norm(n: &Norm<Self>) -> (FloatTensor<Self>, Moments) {
        let cols = cols(&n.x);
        with(&n.x, |x| {
            let moments = norm::moments(x, cols);
            let (factor, summand) =
                with(&n.scale, |scale| with(&n.shift, |shift| norm::affine(&moments, scale, shift)));
            (tensor(norm::apply(x, &factor, &summand, n.relu), cols), moments)
        })
    }

    fn norm_backward(n: &Norm<Self>, moments: &Moments, dy: FloatTensor<Self>) -> [FloatTensor<Self>; 3] {
        let cols = cols(&n.x);
        // Storage may be more than the tensor, or in another order.
        let is_plain = dy.as_slice::<f32>().is_some_and(|values| values.len() == dy.storage::<f32>().len());
        let mut dx = if is_plain { dy } else { tensor(Self::read(&dy), cols) };
        let dy = dx.storage_mut::<f32>();
        let mut run = |x: &[f32], scale: &[f32], shift: &[f32]| norm::backward(x, moments, scale, shift, dy, n.relu);
        let d = with(&n.x, |x| with(&n.scale, |scale| with(&n.shift, |shift| run(x, scale, shift))));
        [dx, tensor(d.scale, cols), tensor(d.shift, cols)]
    }

    fn cross_entropy(logits: &FloatTensor<Self>, size: Size, target: Target<'_>) -> (f64, FloatTensor<Self>) {
        let (loss, slope) = with(logits, |logits| loss::cross_entropy(logits, size, target));
        (loss, tensor(slope, size.channels))
    }
}
