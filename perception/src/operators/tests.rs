//! Every operator against the engine's own, over random shapes.
//!
//! Both sum in other orders and round at other places, so that values may be [`TOLERANCE`] of the largest one apart.

use proptest::prelude::*;
use tract_onnx::tract_core::ops::binary::TypedBinOp;
use tract_onnx::tract_core::ops::cnn::{Conv, KernelFormat, MaxPool, PaddingSpec, PoolSpec, SumPool};
use tract_onnx::tract_core::ops::logic::{Iff, comp_gt};
use tract_onnx::tract_core::ops::math;
use tract_onnx::tract_core::ops::nn::DataFormat;
use tract_onnx::tract_core::ops::nn::resize::{CoordTransformer, Interpolator, Nearest, Resize};
use tract_onnx::tract_hir::internal::*;

use super::prepare;

/// Largest difference, as a share of the largest value.
const TOLERANCE: f32 = 1e-5;

/// Values without any order, -1 to 1.
fn values(shape: &[usize], seed: u32) -> Tensor {
    let mixed = |i: usize| (i as u32 ^ seed.wrapping_mul(0x85eb_ca6b)).wrapping_mul(0x9e37_79b9).rotate_left(13);
    let value = |i: usize| mixed(i).wrapping_mul(0xc2b2_ae35) as i32 as f32 / 2f32.powi(31);
    let all: Vec<f32> = (0..shape.iter().product()).map(value).collect();
    Tensor::from_shape(shape, &all).unwrap()
}

/// A model of one input that is wired by a function.
fn model(shape: &[usize], wire: impl FnOnce(&mut TypedModel, OutletId) -> OutletId) -> TypedModel {
    let mut model = TypedModel::default();
    let x = model.add_source("x", f32::fact(shape)).unwrap();
    let y = wire(&mut model, x);
    model.select_output_outlets(&[y]).unwrap();
    model
}

fn run(model: TypedModel, x: &Tensor) -> Tensor {
    let model = model.into_optimized().unwrap().into_runnable().unwrap();
    model.run(tvec!(x.clone().into_tvalue())).unwrap().remove(0).into_tensor()
}

fn floats(tensor: &Tensor) -> Vec<f32> {
    tensor.try_as_plain_ram().unwrap().as_slice::<f32>().unwrap().to_vec()
}

/// Asserts that ours comes to what the engine's own comes to, and that these operators of ours were used.
fn check(model: &TypedModel, expected: &[&str]) {
    let shape = model.input_fact(0).unwrap().shape.as_concrete().unwrap().to_vec();
    let x = values(&shape, 1);
    let ours = prepare(model.clone()).unwrap();
    let names: Vec<String> = ours.nodes().iter().map(|node| node.op().name().into_owned()).collect();
    for name in expected {
        assert!(names.iter().any(|found| found == name), "{name} is not among {names:?}");
    }
    assert!(!names.iter().any(|name| name == "Iff"), "a PReLU was overlooked: {names:?}");
    let (theirs, first) = (run(model.clone(), &x), run(ours.clone(), &x));
    assert_eq!(theirs.shape(), first.shape());
    let (theirs, first, second) = (floats(&theirs), floats(&first), floats(&run(ours, &x)));
    assert!(first.iter().zip(&second).all(|(a, b)| a.to_bits() == b.to_bits()), "two runs differ");
    let largest = theirs.iter().fold(1.0f32, |largest, value| largest.max(value.abs()));
    let worst = theirs.iter().zip(&first).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(worst <= TOLERANCE * largest, "{worst} apart where values reach {largest}");
}

fn spec(
    channels: [usize; 2],
    kernel: [usize; 2],
    stride: [usize; 2],
    dilation: [usize; 2],
    pads: [usize; 4],
) -> PoolSpec {
    PoolSpec {
        data_format: DataFormat::NCHW,
        kernel_shape: kernel[..].into(),
        padding: PaddingSpec::Explicit(pads[..2].into(), pads[2..].into()),
        dilations: Some(dilation[..].into()),
        strides: Some(stride[..].into()),
        input_channels: channels[0],
        output_channels: channels[1],
    }
}

fn wire_conv(model: &mut TypedModel, x: OutletId, spec: PoolSpec, group: usize) -> OutletId {
    let [inputs, outputs] = [spec.input_channels, spec.output_channels];
    let shape = [outputs, inputs / group, spec.kernel_shape[0], spec.kernel_shape[1]];
    let weights = model.add_const("weights", values(&shape, 2)).unwrap();
    let bias = model.add_const("bias", values(&[outputs], 3)).unwrap();
    let conv = Conv { pool_spec: spec, kernel_fmt: KernelFormat::OIHW, group, q_params: None };
    model.wire_node("conv", conv, &[x, weights, bias]).unwrap()[0]
}

fn wire_binary(model: &mut TypedModel, op: TypedBinOp, name: &str, a: OutletId, b: Tensor) -> OutletId {
    let b = model.add_const(format!("{name}.b"), b).unwrap();
    model.wire_node(name, op, &[a, b]).unwrap()[0]
}

fn wire_prelu(model: &mut TypedModel, x: OutletId, channels: usize) -> OutletId {
    let zero = model.add_const("zero", Tensor::zero::<f32>(&[1, 1, 1, 1]).unwrap()).unwrap();
    let product = wire_binary(model, math::mul(), "product", x, values(&[1, channels, 1, 1], 5));
    let test = model.wire_node("test", TypedBinOp(comp_gt(), None), &[zero, x]).unwrap()[0];
    model.wire_node("iff", Iff, &[test, product, x]).unwrap()[0]
}

type Sizes = (usize, [usize; 2], [usize; 2], [usize; 2], [usize; 2], [usize; 4]);

/// Batch, size, kernel, stride, dilation and pads, where the kernel fits.
fn sizes() -> impl Strategy<Value = Sizes> {
    let kernel = [1..=5usize, 1..=5];
    let sizes = (
        1..=2usize,
        [1..=19usize, 1..=23],
        kernel,
        [1..=3usize, 1..=3],
        [1..=3usize, 1..=3],
        [0..=3usize, 0..=3, 0..=3, 0..=3],
    );
    sizes.prop_filter("the kernel fits", |(_, size, kernel, _, dilation, pads)| {
        (0..2).all(|axis| size[axis] + pads[axis] + pads[axis + 2] > (kernel[axis] - 1) * dilation[axis])
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, ..ProptestConfig::default() })]

    #[test]
    fn convolutions_agree_with_the_engine(
        (batch, [rows, cols], kernel, stride, dilation, pads) in sizes(),
        inputs in 1..=5usize,
        outputs in 1..=70usize,
        (group, end) in (1..=2usize, 0..=4usize),
    ) {
        let (inputs, outputs) = (inputs * group, if group > 1 { 16 * group } else { outputs });
        let spec = spec([inputs, outputs], kernel, stride, dilation, pads);
        let network = model(&[batch, inputs, rows, cols], |model, x| {
            let y = wire_conv(model, x, spec, group);
            let channels = [1, outputs, 1, 1];
            match end {
                1 => {
                    let y = wire_binary(model, math::mul(), "scale", y, values(&channels, 6));
                    let y = wire_binary(model, math::add(), "shift", y, values(&channels, 7));
                    wire_binary(model, math::max(), "low", y, Tensor::zero::<f32>(&[1, 1, 1, 1]).unwrap())
                }
                2 => wire_prelu(model, y, outputs),
                3 => model.wire_node("hard", tract_onnx::tract_core::ops::nn::hard_swish(), &[y]).unwrap()[0],
                4 => {
                    let y = wire_binary(model, math::min(), "high", y, Tensor::from_shape(&[1, 1, 1, 1], &[0.5f32]).unwrap());
                    model.wire_node("twice", math::add(), &[y, y]).unwrap()[0]
                }
                _ => y,
            }
        });
        check(&network, &["Convolve"]);
    }

    #[test]
    fn depthwise_convolutions_agree_with_the_engine(
        (batch, [rows, cols], kernel, stride, dilation, pads) in sizes(),
        channels in 2..=70usize,
        is_nine in any::<bool>(),
    ) {
        let kernel = if is_nine { [3, 3] } else { kernel };
        let fits = (0..2).all(|i| [rows, cols][i] + pads[i] + pads[i + 2] > (kernel[i] - 1) * dilation[i]);
        prop_assume!(fits);
        let spec = spec([channels; 2], kernel, stride, dilation, pads);
        let network = model(&[batch, channels, rows, cols], |model, x| {
            let y = wire_conv(model, x, spec, channels);
            if is_nine { wire_prelu(model, y, channels) } else { y }
        });
        check(&network, &["Depthwise"]);
    }

    #[test]
    fn pools_agree_with_the_engine(
        (batch, [rows, cols], kernel, stride, _, pads) in sizes(),
        channels in 1..=20usize,
        kind in 0..=2usize,
    ) {
        // Padding is less than the window, as ONNX has it.
        let pads: [usize; 4] = std::array::from_fn(|i| pads[i].min(kernel[i % 2] - 1));
        prop_assume!((0..2).all(|i| [rows, cols][i] + pads[i] + pads[i + 2] >= kernel[i]));
        let pool_spec = spec([channels; 2], kernel, stride, [1, 1], pads);
        let network = model(&[batch, channels, rows, cols], |model, x| match kind {
            0 => model.wire_node("pool", MaxPool { pool_spec, with_index_outputs: None }, &[x]).unwrap()[0],
            kind => {
                let pool = SumPool { pool_spec, count_include_pad: kind == 1, normalize: true };
                model.wire_node("pool", pool, &[x]).unwrap()[0]
            }
        });
        check(&network, &["Pool"]);
    }

    #[test]
    fn resizes_agree_with_the_engine(
        (batch, channels, rows, cols) in (1..=2usize, 1..=20usize, 1..=17usize, 1..=17usize),
        (out_rows, out_cols) in (1..=40usize, 1..=40usize),
        (mode, how) in (0..=1usize, 0..=3usize),
    ) {
        use CoordTransformer::{AlignCorners, Asymmetric, HalfPixel, PytorchHalfPixel};
        let op = Resize {
            coord_transformer: [HalfPixel, AlignCorners, Asymmetric, PytorchHalfPixel][how].clone(),
            interpolator: [Interpolator::Linear, Interpolator::Nearest][mode].clone(),
            nearest: Nearest::Floor,
            optional_scales_input: None,
            optional_sizes_input: Some(1),
        };
        let sizes = [batch, channels, out_rows, out_cols].map(|n| n as i64);
        let network = model(&[batch, channels, rows, cols], |model, x| {
            let sizes = model.add_const("sizes", rctensor1(&sizes)).unwrap();
            model.wire_node("resize", op, &[x, sizes]).unwrap()[0]
        });
        let is_same = (rows, cols) == (out_rows, out_cols);
        check(&network, if is_same { &[] } else { &["ResizeRowsAndColumns"] });
    }

    #[test]
    fn branches_that_meet_agree_with_the_engine(
        (rows, cols, inputs, outputs) in (2..=12usize, 2..=12usize, 2..=40usize, 2..=40usize),
        is_clamped in any::<bool>(),
    ) {
        let network = model(&[1, inputs, rows, cols], |model, x| {
            let narrow = spec([inputs, outputs], [1, 1], [1, 1], [1, 1], [0; 4]);
            let a = wire_conv(model, x, narrow, 1);
            let wide = spec([inputs, outputs], [3, 3], [1, 1], [1, 1], [1; 4]);
            let weights = model.add_const("more", values(&[outputs, inputs, 3, 3], 8)).unwrap();
            let bias = model.add_const("more.bias", values(&[outputs], 9)).unwrap();
            let conv = Conv { pool_spec: wide, kernel_fmt: KernelFormat::OIHW, group: 1, q_params: None };
            let b = model.wire_node("wide", conv, &[x, weights, bias]).unwrap()[0];
            let sum = model.wire_node("sum", math::add(), &[a, b]).unwrap()[0];
            let sum = match is_clamped {
                true => wire_binary(model, math::max(), "low", sum, Tensor::zero::<f32>(&[1, 1, 1, 1]).unwrap()),
                false => sum,
            };
            let after = model.add_const("after", values(&[3, outputs, 1, 1], 10)).unwrap();
            let bias = model.add_const("after.bias", values(&[3], 11)).unwrap();
            let pool_spec = spec([outputs, 3], [1, 1], [1, 1], [1, 1], [0; 4]);
            let conv = Conv { pool_spec, kernel_fmt: KernelFormat::OIHW, group: 1, q_params: None };
            model.wire_node("end", conv, &[sum, after, bias]).unwrap()[0]
        });
        check(&network, &["Convolve"]);
        let adds = |model: &TypedModel| model.nodes().iter().filter(|node| node.op().name() == "Add").count();
        prop_assert_eq!(adds(&prepare(network).unwrap()), 0, "the sum is made in a convolution");
    }

    #[test]
    fn products_that_resize_agree_with_the_engine(
        (channels, rows, cols, outputs) in (1..=9usize, 2..=9usize, 2..=9usize, 2..=20usize),
        (is_rows, is_padded) in (any::<bool>(), any::<bool>()),
    ) {
        use tract_onnx::tract_core::ops::einsum::EinSum;
        let inputs = if is_rows { rows } else { cols };
        // Two neighbours for each output.
        let mut matrix = vec![0.0f32; inputs * outputs];
        for output in 0..outputs {
            let from = output * (inputs - 1) / outputs;
            let at = |input: usize| if is_rows { output * inputs + input } else { input * outputs + output };
            (matrix[at(from)], matrix[at(from + 1)]) = (0.25, 0.75);
        }
        let shape = if is_rows { [outputs, inputs] } else { [inputs, outputs] };
        let network = model(&[1, channels, rows, cols], |model, x| {
            let dims = [if is_padded { &[1, 1][..] } else { &[] }, &shape].concat();
            let matrix = model.add_const("matrix", Tensor::from_shape(&dims, &matrix).unwrap()).unwrap();
            let (axes, wires) = match (is_rows, is_padded) {
                (true, false) => ("mk,abkn->abmn", [matrix, x]),
                (true, true) => ("abmk,abkn->abmn", [matrix, x]),
                (false, false) => ("abmk,kn->abmn", [x, matrix]),
                (false, true) => ("abmk,abkn->abmn", [x, matrix]),
            };
            let op = EinSum { axes: axes.parse().unwrap(), operating_dt: f32::datum_type(), q_params: None };
            model.wire_node("product", op, &wires).unwrap()[0]
        });
        let is_narrow = 2 * outputs <= 2 * inputs.max(outputs) + 4;
        check(&network, if is_narrow { &["ResizeRowsAndColumns"] } else { &[] });
    }

    #[test]
    fn numbers_of_channels_agree_with_the_engine(
        (rows, cols, channels) in (2..=9usize, 2..=9usize, 2..=40usize),
        kind in 0..=2usize,
    ) {
        let network = model(&[1, rows, cols, channels], |model, x| {
            let op = [math::add(), math::sub(), math::mul()][kind].clone();
            wire_binary(model, op, "numbers", x, values(&[1, 1, 1, channels], 4))
        });
        check(&network, &["ByChannel"]);
    }
}
