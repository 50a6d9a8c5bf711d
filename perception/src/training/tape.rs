//! Runs the network on burn's tape and reads the derivatives off it.
//!
//! Feature maps are matrices with a row for every position of every image: 1x1 convolutions are
//! products. Everything is generic over the burn backend that brings the [`Kernels`].

use burn_autodiff::Autodiff;
use burn_autodiff::checkpoint::base::Checkpointer;
use burn_autodiff::checkpoint::strategy::NoCheckpointing;
use burn_autodiff::grads::Gradients;
use burn_autodiff::ops::{Backward, Ops, OpsKind};
use burn_backend::ops::{ActivationOps, FloatTensorOps};
use burn_backend::tensor::{Device, FloatTensor};
use burn_backend::{AutodiffBackend, Backend, Shape, TensorData, TensorMetadata};

use super::kernels::depthwise::Geometry;
use super::kernels::loss::Target;
use super::network::{Graph, Kernel, Resample, Size, fast_scnn};
use super::resample;
use super::weights::{Moments, Parameter, Weights};
use crate::classes::TRAIN_CLASSES;

/// What a backend must bring to train here, beyond what burn asks of it. Tensors are matrices with
/// one column a channel.
pub(super) trait Kernels: Backend {
    /// The tensor's numbers, row by row.
    fn read(tensor: &FloatTensor<Self>) -> Vec<f32>;
    /// 3x3 neighbourhoods with stride 2 as rows.
    fn patches(images: &FloatTensor<Self>, size: Size) -> FloatTensor<Self>;
    fn depthwise(x: &FloatTensor<Self>, weights: &FloatTensor<Self>, geometry: Geometry) -> FloatTensor<Self>;
    /// Derivatives by the input and by the weights.
    fn depthwise_backward(
        x: &FloatTensor<Self>,
        weights: &FloatTensor<Self>,
        dy: &FloatTensor<Self>,
        geometry: Geometry,
    ) -> [FloatTensor<Self>; 2];
    /// Batch normalisation with its parameters.
    fn norm(norm: &Norm<Self>) -> (FloatTensor<Self>, Moments);
    /// Derivatives by the input, the scale and the shift.
    fn norm_backward(norm: &Norm<Self>, moments: &Moments, dy: FloatTensor<Self>) -> [FloatTensor<Self>; 3];
    /// The loss and its derivative by the logits.
    fn cross_entropy(logits: &FloatTensor<Self>, size: Size, target: Target<'_>) -> (f64, FloatTensor<Self>);
}

/// A batch normalisation and what goes into it.
#[derive(Clone, Debug)]
pub(super) struct Norm<B: Backend> {
    pub(super) x: FloatTensor<B>,
    pub(super) scale: FloatTensor<B>,
    pub(super) shift: FloatTensor<B>,
    pub(super) relu: bool,
}

/// What one replica learns from its share of a batch.
#[derive(Default)]
pub(super) struct Lesson {
    pub(super) loss: f64,
    /// By every parameter.
    pub(super) gradients: Vec<Vec<f32>>,
    /// Of every layer.
    pub(super) moments: Vec<Moments>,
}

impl Lesson {
    /// All derivatives and moments, in a fixed order.
    pub(super) fn vectors(&mut self) -> impl Iterator<Item = &mut Vec<f32>> {
        let moments = self.moments.iter_mut().flat_map(|m| [&mut m.mean, &mut m.variance]);
        self.gradients.iter_mut().chain(moments)
    }
}

/// Loss, derivatives and moments for `images` (row by row, red, green, blue, normalised) of the
/// target's size.
pub(super) fn learn<B: Kernels>(weights: &Weights, images: Vec<f32>, target: Target<'_>, device: &Device<B>) -> Lesson {
    let size = Size { rows: target.height, cols: target.width, channels: 3 };
    let mut tape = Tape::<B>::new(weights, device.clone());
    let image = tape.image(images, size);
    let logits = fast_scnn(&mut tape, &image, TRAIN_CLASSES.len());
    let (loss, scalar) = tape.loss(logits, target);
    let gradients = <Autodiff<B> as AutodiffBackend>::backward(scalar);
    Lesson { loss, gradients: tape.gradients(&gradients), moments: tape.moments }
}

/// The logits of `images`, position by position, under batch normalisation by their own moments,
/// which come second.
#[cfg(test)]
pub(super) fn logits<B: Kernels>(
    weights: &Weights,
    images: Vec<f32>,
    rows: usize,
    cols: usize,
    device: &Device<B>,
) -> (Vec<f32>, Vec<Moments>) {
    let mut tape = Tape::<B>::new(weights, device.clone());
    let image = tape.image(images, Size { rows, cols, channels: 3 });
    let logits = fast_scnn(&mut tape, &image, TRAIN_CLASSES.len());
    (B::read(logits.tensor.primitive()), tape.moments)
}

type Tracked<B> = FloatTensor<Autodiff<B>>;

/// A feature map of every image of the batch.
pub(super) struct Map<B: Kernels> {
    tensor: Tracked<B>,
    size: Size,
}

impl<B: Kernels> Clone for Map<B> {
    fn clone(&self) -> Self {
        Self { tensor: self.tensor.clone(), size: self.size }
    }
}

/// The network's operations, recorded while they run.
pub(super) struct Tape<B: Kernels> {
    device: Device<B>,
    parameters: Vec<Tracked<B>>,
    /// Parameters that the walk has passed.
    used: usize,
    moments: Vec<Moments>,
}

impl<B: Kernels> Tape<B> {
    fn new(weights: &Weights, device: Device<B>) -> Self {
        let leaf = |p: &Parameter| {
            let tensor = constant::<B>(p.values.clone(), [p.rows, p.cols], &device);
            Autodiff::<B>::float_set_require_grad(tensor, true)
        };
        let parameters = weights.parameters.iter().map(leaf).collect();
        Self { device, parameters, used: 0, moments: Vec::new() }
    }

    fn image(&self, images: Vec<f32>, size: Size) -> Map<B> {
        let rows = images.len() / size.channels;
        Map { tensor: constant::<B>(images, [rows, size.channels], &self.device), size }
    }

    fn parameter(&mut self) -> Tracked<B> {
        self.used += 1;
        self.parameters[self.used - 1].clone()
    }

    fn convolve(&mut self, x: &Map<B>, kernel: Kernel) -> Tracked<B> {
        let weights = self.parameter();
        match kernel {
            Kernel::Pointwise { .. } => Autodiff::<B>::float_matmul(x.tensor.clone(), weights),
            Kernel::Stem { .. } => {
                let patches = B::patches(x.tensor.primitive(), x.size);
                Autodiff::<B>::float_matmul(Autodiff::<B>::from_inner(patches), weights)
            }
            Kernel::Depthwise { stride, dilation } => {
                depthwise::<B>(x.tensor.clone(), weights, Geometry { input: x.size, stride, dilation })
            }
        }
    }

    fn loss(&self, logits: Map<B>, target: Target<'_>) -> (f64, Tracked<B>) {
        let (loss, slope) = B::cross_entropy(logits.tensor.primitive(), logits.size, target);
        let value = B::float_from_data(TensorData::new(vec![loss as f32], [1, 1]), &self.device);
        let prepared = Loss.prepare::<NoCheckpointing>([logits.tensor.node()]).compute_bound().stateful();
        (loss, finish(prepared, slope, value))
    }

    fn gradients(&self, gradients: &Gradients) -> Vec<Vec<f32>> {
        let read = |p| <Autodiff<B> as AutodiffBackend>::grad(p, gradients).map(|g| B::read(&g));
        self.parameters.iter().map(|p| read(p).unwrap_or_default()).collect()
    }
}

fn constant<B: Kernels>(values: Vec<f32>, shape: [usize; 2], device: &Device<B>) -> Tracked<B> {
    Autodiff::<B>::from_inner(B::float_from_data(TensorData::new(values, shape), device))
}

impl<B: Kernels> Graph for Tape<B> {
    type Node = Map<B>;

    fn size(&self, x: &Map<B>) -> Size {
        x.size
    }

    fn layer(&mut self, x: &Map<B>, kernel: Kernel, relu: bool) -> Map<B> {
        let convolved = self.convolve(x, kernel);
        let (scale, shift) = (self.parameter(), self.parameter());
        let (tensor, moments) = norm::<B>(convolved, scale, shift, relu);
        self.moments.push(moments);
        Map { tensor, size: kernel.output(x.size) }
    }

    fn logits(&mut self, x: &Map<B>, out: usize) -> Map<B> {
        let (weights, bias) = (self.parameter(), self.parameter());
        let product = Autodiff::<B>::float_matmul(x.tensor.clone(), weights);
        Map { tensor: Autodiff::<B>::float_add(product, bias), size: Size { channels: out, ..x.size } }
    }

    fn resample(&mut self, x: &Map<B>, rows: usize, cols: usize, how: Resample) -> Map<B> {
        let Size { rows: from_rows, cols: from_cols, channels } = x.size;
        let images = x.tensor.primitive().shape().num_elements() / (x.size.area() * channels);
        let product = |from: usize, to: usize, x: Tracked<B>, shape: [usize; 3]| {
            let matrix = TensorData::new(resample::matrix(how, from, to), [1, to, from]);
            let matrix = Autodiff::<B>::from_inner(B::float_from_data(matrix, &self.device));
            Autodiff::<B>::float_matmul(matrix, Autodiff::<B>::float_reshape(x, Shape::from(shape)))
        };
        let wide = product(from_cols, cols, x.tensor.clone(), [images * from_rows, from_cols, channels]);
        let tall = product(from_rows, rows, wide, [images, from_rows, cols * channels]);
        let tensor = Autodiff::<B>::float_reshape(tall, Shape::from([images * rows * cols, channels]));
        Map { tensor, size: Size { rows, cols, channels } }
    }

    fn add(&mut self, a: &Map<B>, b: &Map<B>) -> Map<B> {
        Map { tensor: Autodiff::<B>::float_add(a.tensor.clone(), b.tensor.clone()), size: a.size }
    }

    fn relu(&mut self, x: &Map<B>) -> Map<B> {
        Map { tensor: Autodiff::<B>::relu(x.tensor.clone()), size: x.size }
    }

    fn spread(&mut self, x: &Map<B>, side: usize) -> Map<B> {
        let size = x.size.spread(side);
        let lines = x.tensor.primitive().shape().num_elements() / (x.size.cols * x.size.channels);
        let split = Shape::from([lines, x.size.cols, side, side * size.channels]);
        let split = Autodiff::<B>::float_reshape(x.tensor.clone(), split);
        let spread = Autodiff::<B>::float_swap_dims(split, 1, 2);
        let rows = lines * side * size.cols;
        Map { tensor: Autodiff::<B>::float_reshape(spread, Shape::from([rows, size.channels])), size }
    }

    fn concat(&mut self, parts: &[Map<B>]) -> Map<B> {
        let channels = parts.iter().map(|p| p.size.channels).sum();
        let tensor = Autodiff::<B>::float_cat(parts.iter().map(|p| p.tensor.clone()).collect(), 1);
        Map { tensor, size: Size { channels, ..parts[0].size } }
    }
}

/// Puts an operation with its state on the tape where anything before it is learned.
fn finish<O, B, S, const N: usize>(
    prepared: OpsKind<O, B, S, NoCheckpointing, N>,
    state: S,
    output: FloatTensor<B>,
) -> Tracked<B>
where
    O: Backward<B, N, State = S>,
    B: Backend,
    S: Clone + Send + std::fmt::Debug + 'static,
{
    match prepared {
        OpsKind::Tracked(prepared) => prepared.finish(state, output),
        OpsKind::UnTracked(prepared) => prepared.finish(output),
    }
}

#[derive(Debug)]
struct Depthwise;

fn depthwise<B: Kernels>(x: Tracked<B>, weights: Tracked<B>, geometry: Geometry) -> Tracked<B> {
    let y = B::depthwise(x.primitive(), weights.primitive(), geometry);
    let prepared = Backward::<B, 2>::prepare::<NoCheckpointing>(Depthwise, [x.node(), weights.node()]);
    finish(prepared.compute_bound().stateful(), (x.into_primitive(), weights.into_primitive(), geometry), y)
}

impl<B: Kernels> Backward<B, 2> for Depthwise {
    type State = (FloatTensor<B>, FloatTensor<B>, Geometry);

    fn backward(self, ops: Ops<Self::State, 2>, gradients: &mut Gradients, _: &mut Checkpointer) {
        let (x, weights, geometry) = ops.state;
        let dy = gradients.consume::<B>(&ops.node);
        let derivatives = B::depthwise_backward(&x, &weights, &dy, geometry);
        for (parent, derivative) in ops.parents.into_iter().zip(derivatives) {
            if let Some(parent) = parent {
                gradients.register::<B>(parent.id, derivative);
            }
        }
    }
}

#[derive(Debug)]
struct Normalise;

fn norm<B: Kernels>(x: Tracked<B>, scale: Tracked<B>, shift: Tracked<B>, relu: bool) -> (Tracked<B>, Moments) {
    let prepared = Backward::<B, 3>::prepare::<NoCheckpointing>(Normalise, [x.node(), scale.node(), shift.node()]);
    let norm = Norm { x: x.into_primitive(), scale: scale.into_primitive(), shift: shift.into_primitive(), relu };
    let (y, moments) = B::norm(&norm);
    (finish(prepared.compute_bound().stateful(), (norm, moments.clone()), y), moments)
}

impl<B: Kernels> Backward<B, 3> for Normalise {
    type State = (Norm<B>, Moments);

    fn backward(self, ops: Ops<Self::State, 3>, gradients: &mut Gradients, _: &mut Checkpointer) {
        let (norm, moments) = ops.state;
        let dy = gradients.consume::<B>(&ops.node);
        let derivatives = B::norm_backward(&norm, &moments, dy);
        for (parent, derivative) in ops.parents.into_iter().zip(derivatives) {
            if let Some(parent) = parent {
                gradients.register::<B>(parent.id, derivative);
            }
        }
    }
}

/// The loss, whose derivative by the logits is known as soon as the loss is.
#[derive(Debug)]
struct Loss;

impl<B: Kernels> Backward<B, 1> for Loss {
    type State = FloatTensor<B>;

    fn backward(self, ops: Ops<Self::State, 1>, gradients: &mut Gradients, _: &mut Checkpointer) {
        let outer = gradients.consume::<B>(&ops.node);
        let [Some(logits)] = ops.parents else { return };
        gradients.register::<B>(logits.id, B::float_mul(ops.state, outer));
    }
}
