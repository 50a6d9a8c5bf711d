//! Fast-SCNN (Poudel, Liwicki, Cipolla: Fast Semantic Segmentation Network, BMVC 2019, table 1),
//! told once. Who reads it decides what it means: drawing first weights ([`super::weights`]),
//! running it on a tape ([`super::tape`]), or writing ONNX ([`super::export`]).

/// Pixels of the input along one side of a position of the classifier.
const CLASSIFIER_STRIDE: usize = 8;
/// Logits that each position of the classifier gives along one side (dense upsampling convolution,
/// Wang et al., WACV 2018). The paper has one, for pictures 16 times as large; at 256x128 walkers
/// and poles are narrower than a position.
const SHARPNESS: usize = 4;
/// Pixels of the input along one side of a logit.
pub const LOGIT_STRIDE: usize = CLASSIFIER_STRIDE / SHARPNESS;
/// The sides of the input must be multiples of this: the coarsest features have a 32nd of them.
pub(super) const SIDE_MULTIPLE: usize = 32;

/// Expansion of the inverted residuals.
const EXPANSION: usize = 6;
/// Channels, repetitions and first stride of the global feature extractor's stages.
const STAGES: [(usize, usize, usize); 3] = [(64, 3, 2), (96, 3, 2), (128, 3, 1)];
/// Sides of the pooled grids of the pyramid.
const PYRAMID: [usize; 4] = [1, 2, 3, 6];
/// Channels after fusion.
const FUSED: usize = 128;
/// Dilation of the depthwise convolution that follows upsampling in the fusion.
const FUSION_DILATION: usize = 4;

/// Size of a feature map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Size {
    pub(super) rows: usize,
    pub(super) cols: usize,
    pub(super) channels: usize,
}

impl Size {
    /// Positions of the map.
    pub(super) fn area(self) -> usize {
        self.rows * self.cols
    }

    /// With positions split into `side` x `side`, which share the channels.
    pub(super) fn spread(self, side: usize) -> Self {
        Self { rows: self.rows * side, cols: self.cols * side, channels: self.channels / (side * side) }
    }

    /// After a 3x3 convolution whose padding equals its dilation.
    pub(super) fn strided(self, stride: usize) -> Self {
        Self { rows: self.rows.div_ceil(stride), cols: self.cols.div_ceil(stride), ..self }
    }
}

/// A convolution without bias; those of 3x3 are padded with as many zeros as their dilation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kernel {
    /// 3x3 with stride 2 over all channels of the image.
    Stem { out: usize },
    /// 1x1.
    Pointwise { out: usize },
    /// 3x3 in each channel by itself.
    Depthwise { stride: usize, dilation: usize },
}

impl Kernel {
    /// Size of the output.
    pub(super) fn output(self, input: Size) -> Size {
        match self {
            Self::Stem { out } => Size { channels: out, ..input.strided(2) },
            Self::Pointwise { out } => Size { channels: out, ..input },
            Self::Depthwise { stride, .. } => input.strided(stride),
        }
    }

    /// Rows and columns of the weights: taps times input channels (one for a depthwise kernel) by
    /// output channels.
    pub(super) fn weights(self, input: Size) -> (usize, usize) {
        match self {
            Self::Stem { out } => (9 * input.channels, out),
            Self::Pointwise { out } => (input.channels, out),
            Self::Depthwise { .. } => (9, input.channels),
        }
    }
}

/// How a feature map gets another number of rows and columns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Resample {
    /// Mean over bins that cover the map (adaptive average pooling).
    Pool,
    /// Bilinear, edges onto edges (half-pixel centres).
    Bilinear,
}

/// What the network is built from.
pub(super) trait Graph {
    /// A feature map.
    type Node: Clone;

    fn size(&self, x: &Self::Node) -> Size;
    /// A convolution, batch normalisation and, if asked for, a rectifier.
    fn layer(&mut self, x: &Self::Node, kernel: Kernel, relu: bool) -> Self::Node;
    /// A 1x1 convolution with bias.
    fn logits(&mut self, x: &Self::Node, out: usize) -> Self::Node;
    fn resample(&mut self, x: &Self::Node, rows: usize, cols: usize, how: Resample) -> Self::Node;
    fn add(&mut self, a: &Self::Node, b: &Self::Node) -> Self::Node;
    fn relu(&mut self, x: &Self::Node) -> Self::Node;
    /// Lays the channels of a position out as `side` x `side` positions: channel
    /// `(dy * side + dx) * n + c` of `side * side * n` becomes channel `c` at row `dy`, column `dx`.
    fn spread(&mut self, x: &Self::Node, side: usize) -> Self::Node;
    /// Joins the channels.
    fn concat(&mut self, parts: &[Self::Node]) -> Self::Node;
}

/// The network from the normalised image to its logits at [`LOGIT_STRIDE`].
pub(super) fn fast_scnn<G: Graph>(g: &mut G, image: &G::Node, classes: usize) -> G::Node {
    let fine = learning_to_downsample(g, image);
    let coarse = global_features(g, &fine);
    let fused = fusion(g, &fine, &coarse);
    let x = separable(g, &fused, FUSED, 1);
    let x = separable(g, &x, FUSED, 1);
    let logits = g.logits(&x, SHARPNESS * SHARPNESS * classes);
    g.spread(&logits, SHARPNESS)
}

fn learning_to_downsample<G: Graph>(g: &mut G, image: &G::Node) -> G::Node {
    let x = g.layer(image, Kernel::Stem { out: 32 }, true);
    let x = separable(g, &x, 48, 2);
    separable(g, &x, 64, 2)
}

/// Depthwise separable convolution; the paper omits the rectifier between its halves.
fn separable<G: Graph>(g: &mut G, x: &G::Node, out: usize, stride: usize) -> G::Node {
    let x = g.layer(x, Kernel::Depthwise { stride, dilation: 1 }, false);
    g.layer(&x, Kernel::Pointwise { out }, true)
}

fn global_features<G: Graph>(g: &mut G, fine: &G::Node) -> G::Node {
    let mut x = fine.clone();
    for (out, repetitions, first_stride) in STAGES {
        for i in 0..repetitions {
            x = inverted_residual(g, &x, out, if i == 0 { first_stride } else { 1 });
        }
    }
    pyramid_pooling(g, &x)
}

fn inverted_residual<G: Graph>(g: &mut G, x: &G::Node, out: usize, stride: usize) -> G::Node {
    let channels = g.size(x).channels;
    let y = g.layer(x, Kernel::Pointwise { out: EXPANSION * channels }, true);
    let y = g.layer(&y, Kernel::Depthwise { stride, dilation: 1 }, true);
    let y = g.layer(&y, Kernel::Pointwise { out }, false);
    if stride == 1 && channels == out { g.add(x, &y) } else { y }
}

fn pyramid_pooling<G: Graph>(g: &mut G, x: &G::Node) -> G::Node {
    let size = g.size(x);
    let mut parts = vec![x.clone()];
    for side in PYRAMID {
        let pooled = g.resample(x, side, side, Resample::Pool);
        let pooled = g.layer(&pooled, Kernel::Pointwise { out: size.channels / PYRAMID.len() }, true);
        parts.push(g.resample(&pooled, size.rows, size.cols, Resample::Bilinear));
    }
    let joined = g.concat(&parts);
    g.layer(&joined, Kernel::Pointwise { out: size.channels }, true)
}

fn fusion<G: Graph>(g: &mut G, fine: &G::Node, coarse: &G::Node) -> G::Node {
    let size = g.size(fine);
    let x = g.resample(coarse, size.rows, size.cols, Resample::Bilinear);
    let x = g.layer(&x, Kernel::Depthwise { stride: 1, dilation: FUSION_DILATION }, true);
    let x = g.layer(&x, Kernel::Pointwise { out: FUSED }, false);
    let fine = g.layer(fine, Kernel::Pointwise { out: FUSED }, false);
    let sum = g.add(&x, &fine);
    g.relu(&sum)
}
