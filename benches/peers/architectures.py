"""Exports networks of many architectures with random weights to ONNX, to be timed and compared (`engines.sh`).

Usage: architectures.py FOLDER [WIDTH HEIGHT]

Each takes pictures of one size and gives scores of 19 classes (Cityscapes). The last layer is calibrated on pictures
with structure, so that every class wins somewhere: a network with random weights predicts one class everywhere, and
then masks that agree show nothing. A sidecar `NAME.toml` tells what the input means.
"""

import pathlib
import sys

import torch
import torch.nn.functional as F
from torch import nn

CLASSES = 19
MEAN = (0.485, 0.456, 0.406)
STD = (0.229, 0.224, 0.225)


def conv(cin, cout, k=3, stride=1, dilation=1, groups=1, act=nn.ReLU):
    """Convolution, normalisation, activation."""
    pad = dilation * (k // 2)
    layers = [nn.Conv2d(cin, cout, k, stride, pad, dilation, groups, bias=False), nn.BatchNorm2d(cout)]
    return nn.Sequential(*layers, *([act()] if act else []))


def up(x, like, mode="bilinear", align=False):
    """Resized to the rows and columns of another value."""
    size = like if isinstance(like, tuple) else tuple(like.shape[2:])
    return F.interpolate(x, size, mode=mode, align_corners=align if mode == "bilinear" else None)


class Inverted(nn.Module):
    """Inverted residual block with optional squeeze and excitation (MobileNet V2 and V3)."""

    def __init__(self, cin, cout, stride=1, expand=6, k=3, dilation=1, act=nn.ReLU6, squeeze=False):
        super().__init__()
        mid = cin * expand
        self.head = conv(cin, mid, 1, act=act)
        self.deep = conv(mid, mid, k, stride, dilation, mid, act=act)
        narrow = [nn.AdaptiveAvgPool2d(1), nn.Conv2d(mid, mid // 4, 1), nn.ReLU()]
        self.squeeze = nn.Sequential(*narrow, nn.Conv2d(mid // 4, mid, 1), nn.Hardsigmoid()) if squeeze else None
        self.tail = conv(mid, cout, 1, act=None)
        self.skip = stride == 1 and cin == cout

    def forward(self, x):
        y = self.deep(self.head(x))
        if self.squeeze is not None:
            y = y * self.squeeze(y)
        y = self.tail(y)
        return x + y if self.skip else y


class Basic(nn.Module):
    """The block of ResNet-18."""

    def __init__(self, cin, cout, stride=1):
        super().__init__()
        self.a, self.b = conv(cin, cout, 3, stride), conv(cout, cout, act=None)
        self.skip = conv(cin, cout, 1, stride, act=None) if stride > 1 or cin != cout else nn.Identity()

    def forward(self, x):
        return F.relu(self.b(self.a(x)) + self.skip(x))


class ResNet(nn.Module):
    """Stages of ResNet-18 at 1/4, 1/8, 1/16 and 1/32."""

    def __init__(self, widths=(64, 128, 256, 512)):
        super().__init__()
        self.stem = nn.Sequential(conv(3, widths[0], 7, 2), nn.MaxPool2d(3, 2, 1))
        ins = (widths[0], *widths)
        stages = [nn.Sequential(Basic(ins[i], w, 1 if i == 0 else 2), Basic(w, w)) for i, w in enumerate(widths)]
        self.stages = nn.ModuleList(stages)

    def forward(self, x):
        x, out = self.stem(x), []
        for stage in self.stages:
            x = stage(x)
            out.append(x)
        return out


class Pyramid(nn.Module):
    """Pyramid pooling: averages over grids of 1, 2, 3 and 6 cells."""

    def __init__(self, cin, cout):
        super().__init__()
        self.branches = nn.ModuleList([conv(cin, cin // 4, 1) for _ in range(4)])
        self.out = conv(2 * cin, cout, 1)

    def forward(self, x):
        rows, cols = x.shape[2:]
        parts = [x]
        for cells, branch in zip((1, 2, 4, 8), self.branches):
            size = (max(1, rows // cells), max(1, cols // cells))
            parts.append(up(branch(F.avg_pool2d(x, size, size)), x))
        return self.out(torch.cat(parts, 1))


class FastScnn(nn.Module):
    def __init__(self):
        super().__init__()
        apart = lambda cin, cout, stride: nn.Sequential(conv(cin, cin, 3, stride, 1, cin), conv(cin, cout, 1))
        self.shallow = nn.Sequential(conv(3, 32, 3, 2), apart(32, 48, 2), apart(48, 64, 2))
        stages = [(64, 64, 2), (64, 64, 1), (64, 64, 1), (64, 96, 2), (96, 96, 1), (96, 96, 1), (96, 128, 1)]
        blocks = [Inverted(a, b, s, act=nn.ReLU) for a, b, s in stages]
        self.deep = nn.Sequential(*blocks, Inverted(128, 128), Inverted(128, 128), Pyramid(128, 128))
        self.low = nn.Sequential(conv(128, 128, 3, 1, 1, 128), conv(128, 128, 1, act=None))
        self.high = conv(64, 128, 1, act=None)
        self.head = nn.Sequential(apart(128, 128, 1), apart(128, 128, 1))
        self.last = nn.Conv2d(128, CLASSES, 1)

    def forward(self, x):
        high = self.shallow(x)
        low = up(self.deep(high), high)
        return self.last(self.head(F.relu(self.low(low) + self.high(high))))


class UNet(nn.Module):
    def __init__(self, transposed=False):
        super().__init__()
        widths = (16, 32, 64, 128, 256)
        double = lambda cin, cout: nn.Sequential(conv(cin, cout), conv(cout, cout))
        self.down = nn.ModuleList([double(a, b) for a, b in zip((3, *widths), widths)])
        pairs = list(zip(widths[::-1], widths[-2::-1]))
        self.ups = nn.ModuleList([nn.ConvTranspose2d(a, b, 2, 2) if transposed else None for a, b in pairs])
        self.merge = nn.ModuleList([double((b if transposed else a) + b, b) for a, b in pairs])
        self.last = nn.Conv2d(16, CLASSES, 1)

    def forward(self, x):
        skips = []
        for i, block in enumerate(self.down):
            x = block(F.max_pool2d(x, 2) if i else x)
            skips.append(x)
        for merge, rise, skip in zip(self.merge, self.ups, skips[-2::-1]):
            x = merge(torch.cat([rise(x) if rise is not None else up(x, skip), skip], 1))
        return self.last(x)


class Mobile(nn.Module):
    """Stages of MobileNet V3 (large, slimmed) at 1/8 and 1/16."""

    def __init__(self):
        super().__init__()
        hard = nn.Hardswish
        self.low = nn.Sequential(
            conv(3, 16, 3, 2, act=hard),
            Inverted(16, 24, 2, 4, act=nn.ReLU),
            Inverted(24, 24, 1, 3, act=nn.ReLU),
            Inverted(24, 40, 2, 3, 5, act=nn.ReLU, squeeze=True),
            Inverted(40, 40, 1, 3, 5, act=nn.ReLU, squeeze=True),
        )
        self.high = nn.Sequential(
            Inverted(40, 80, 2, 6, act=hard),
            Inverted(80, 80, 1, 3, act=hard),
            Inverted(80, 112, 1, 6, act=hard, squeeze=True),
            Inverted(112, 160, 1, 6, 5, 2, act=hard, squeeze=True),
            Inverted(160, 160, 1, 6, 5, 2, act=hard, squeeze=True),
        )

    def forward(self, x):
        low = self.low(x)
        return low, self.high(low)


class DeepLab(nn.Module):
    def __init__(self):
        super().__init__()
        self.body = Mobile()
        self.parts = nn.ModuleList([conv(160, 128, 1), *[conv(160, 128, 3, 1, rate) for rate in (6, 12, 18)]])
        self.mean = nn.Sequential(nn.AdaptiveAvgPool2d(1), nn.Conv2d(160, 128, 1), nn.ReLU())
        self.project = nn.Sequential(conv(5 * 128, 128, 1), conv(128, 128))
        self.last = nn.Conv2d(128, CLASSES, 1)

    def forward(self, x):
        x = self.body(x)[1]
        parts = [part(x) for part in self.parts] + [up(self.mean(x), x)]
        return self.last(self.project(torch.cat(parts, 1)))


class LrAspp(nn.Module):
    def __init__(self):
        super().__init__()
        self.body = Mobile()
        self.main = conv(160, 128, 1)
        self.scale = nn.Sequential(nn.AdaptiveAvgPool2d(1), nn.Conv2d(160, 128, 1, bias=False), nn.Sigmoid())
        self.low, self.last = nn.Conv2d(40, CLASSES, 1), nn.Conv2d(128, CLASSES, 1)

    def forward(self, x):
        low, high = self.body(x)
        return self.low(low) + self.last(up(self.main(high) * self.scale(high), low))


class Fpn(nn.Module):
    def __init__(self):
        super().__init__()
        self.body = ResNet()
        self.side = nn.ModuleList([nn.Conv2d(w, 128, 1) for w in (64, 128, 256, 512)])
        self.smooth = conv(128, 128)
        self.last = nn.Conv2d(128, CLASSES, 1)

    def forward(self, x):
        sides = [side(f) for side, f in zip(self.side, self.body(x))]
        x = sides[-1]
        for side in sides[-2::-1]:
            x = side + up(x, side, "nearest")
        return self.last(self.smooth(x))


class BiSeNet(nn.Module):
    def __init__(self):
        super().__init__()
        self.detail = nn.Sequential(conv(3, 64, 3, 2), conv(64, 64), conv(64, 64, 3, 2), conv(64, 128, 3, 2))
        self.stem = nn.Sequential(conv(3, 16, 3, 2), nn.MaxPool2d(3, 2, 1), conv(16, 32))
        blocks = [(32, 64, 2), (64, 64, 1), (64, 128, 2), (128, 128, 1), (128, 128, 2), (128, 128, 1)]
        self.semantic = nn.Sequential(*[Inverted(a, b, s, act=nn.ReLU) for a, b, s in blocks])
        self.context = conv(128, 128, 1)
        self.detail_gate = nn.Sequential(conv(128, 128, 3, 1, 1, 128, act=None), nn.Conv2d(128, 128, 1))
        self.semantic_gate = conv(128, 128, act=None)
        self.head = conv(128, 128)
        self.last = nn.Conv2d(128, CLASSES, 1)

    def forward(self, x):
        detail, semantic = self.detail(x), self.semantic(self.stem(x))
        semantic = semantic + self.context(semantic.mean((2, 3), keepdim=True))
        gate = torch.sigmoid(up(self.semantic_gate(semantic), detail))
        return self.last(self.head(self.detail_gate(detail) * gate + up(semantic, detail)))


class ENet(nn.Module):
    class Bottleneck(nn.Module):
        def __init__(self, width, dilation=1, lengthy=False):
            super().__init__()
            mid, act = width // 4, lambda: nn.PReLU(width // 4)
            middle = [conv(mid, mid, 3, 1, dilation, act=act)]
            if lengthy:
                row = nn.Conv2d(mid, mid, (1, 5), padding=(0, 2), bias=False)
                middle = [row, nn.Conv2d(mid, mid, (5, 1), padding=(2, 0), bias=False), nn.BatchNorm2d(mid), act()]
            self.body = nn.Sequential(conv(width, mid, 1, act=act), *middle, conv(mid, width, 1, act=None))
            self.act = nn.PReLU(width)

        def forward(self, x):
            return self.act(x + self.body(x))

    def __init__(self):
        super().__init__()
        self.stem = conv(3, 13, 3, 2, act=None)
        self.stem_act = nn.PReLU(16)
        block = self.Bottleneck
        kinds = [(1, False), (2, False), (1, True), (4, False), (1, False), (8, False), (1, True), (16, False)]
        down = lambda cin, cout: conv(cin, cout, 2, 2, act=lambda: nn.PReLU(cout))
        self.first = nn.Sequential(nn.Conv2d(16, 64, 2, 2), nn.PReLU(64), *[block(64) for _ in range(4)])
        self.second = nn.Sequential(nn.Conv2d(64, 128, 2, 2), nn.PReLU(128), *[block(128, *k) for k in 2 * kinds])
        self.rise = nn.Sequential(nn.ConvTranspose2d(128, 64, 2, 2), nn.PReLU(64), block(64), block(64))
        self.last = nn.Conv2d(64, CLASSES, 1)

    def forward(self, x):
        x = self.stem_act(torch.cat([self.stem(x), F.max_pool2d(x, 2)], 1))
        return self.last(self.rise(self.second(self.first(x))))


class SegFormer(nn.Module):
    class Block(nn.Module):
        def __init__(self, width, heads, ratio):
            super().__init__()
            self.heads, self.ratio = heads, ratio
            self.norm_a, self.norm_b = nn.LayerNorm(width), nn.LayerNorm(width)
            self.q, self.kv, self.out = nn.Linear(width, width), nn.Linear(width, 2 * width), nn.Linear(width, width)
            if ratio > 1:
                self.small, self.norm_small = nn.Conv2d(width, width, ratio, ratio), nn.LayerNorm(width)
            self.a, self.b = nn.Linear(width, 4 * width), nn.Linear(4 * width, width)
            self.deep = nn.Conv2d(4 * width, 4 * width, 3, 1, 1, groups=4 * width)

        def forward(self, x, rows, cols):
            n, c = x.shape[1], x.shape[2]
            y = self.norm_a(x)
            q = self.q(y).reshape(1, n, self.heads, c // self.heads).permute(0, 2, 1, 3)
            if self.ratio > 1:
                y = self.small(y.permute(0, 2, 1).reshape(1, c, rows, cols))
                y = self.norm_small(y.reshape(1, c, -1).permute(0, 2, 1))
            kv = self.kv(y).reshape(1, -1, 2, self.heads, c // self.heads).permute(2, 0, 3, 1, 4)
            weights = torch.softmax(q @ kv[0].transpose(-2, -1) * (c // self.heads) ** -0.5, -1)
            x = x + self.out((weights @ kv[1]).transpose(1, 2).reshape(1, n, c))
            y = self.a(self.norm_b(x)).permute(0, 2, 1).reshape(1, 4 * c, rows, cols)
            y = self.deep(y).reshape(1, 4 * c, -1).permute(0, 2, 1)
            return x + self.b(F.gelu(y))

    def __init__(self):
        super().__init__()
        widths, heads, ratios = (32, 64, 160, 256), (1, 2, 5, 8), (8, 4, 2, 1)
        embed = [nn.Conv2d(3, 32, 7, 4, 3), *[nn.Conv2d(a, b, 3, 2, 1) for a, b in zip(widths, widths[1:])]]
        self.embed = nn.ModuleList(embed)
        self.norms = nn.ModuleList([nn.LayerNorm(w) for w in widths])
        self.blocks = nn.ModuleList([self.Block(*args) for args in zip(widths, heads, ratios)])
        self.heads = nn.ModuleList([nn.Conv2d(w, 128, 1) for w in widths])
        self.fuse = conv(4 * 128, 128, 1)
        self.last = nn.Conv2d(128, CLASSES, 1)

    def forward(self, x):
        parts = []
        for embed, norm, block, head in zip(self.embed, self.norms, self.blocks, self.heads):
            x = embed(x)
            c, rows, cols = x.shape[1:]
            x = block(norm(x.reshape(1, c, -1).permute(0, 2, 1)), rows, cols)
            x = x.permute(0, 2, 1).reshape(1, c, rows, cols)
            part = head(x)
            parts.append(up(part, parts[0]) if parts else part)
        return self.last(self.fuse(torch.cat(parts, 1)))


class Whole(nn.Module):
    """A network with its upsampling to the picture, and what else exporters put around it."""

    def __init__(self, body, mode="bilinear", align=False, bytes_last=False, argmax=False):
        super().__init__()
        self.body, self.mode, self.align, self.bytes_last, self.argmax = body, mode, align, bytes_last, argmax
        self.register_buffer("mean", torch.tensor(MEAN).reshape(1, 3, 1, 1) * 255)
        self.register_buffer("std", torch.tensor(STD).reshape(1, 3, 1, 1) * 255)

    def forward(self, image):
        x = (image.permute(0, 3, 1, 2).float() - self.mean) / self.std if self.bytes_last else image
        y = up(self.body(x), tuple(x.shape[2:]), self.mode, self.align)
        if self.argmax:
            return y.argmax(1)
        return y.permute(0, 2, 3, 1) if self.bytes_last else y


def picture(width, height, seed):
    """A normalised picture with areas and soft borders."""
    g = torch.Generator().manual_seed(seed)
    coarse = [F.interpolate(torch.rand(1, 3, 2**k, 2 ** (k + 1), generator=g), (height, width), mode="bilinear")
              for k in range(1, 6)]
    return (sum(coarse) / len(coarse) - 0.5) * 6


@torch.no_grad()
def calibrate(body, width, height):
    """Random weights whose values neither grow nor fade, and a last layer whose every class wins somewhere."""
    for module in body.modules():
        if isinstance(module, (nn.Conv2d, nn.ConvTranspose2d, nn.Linear)):
            nn.init.kaiming_normal_(module.weight, nonlinearity="relu")
    pictures = [picture(width, height, seed) for seed in range(6)]
    body.train()
    for module in body.modules():
        if isinstance(module, nn.BatchNorm2d):
            module.momentum = None
    # Together where the network takes several: what is a mean of a picture differs between them only.
    for images in pictures if isinstance(body, SegFormer) else [torch.cat(pictures)]:
        body(images)
    body.eval()
    scores = torch.cat([body(image).transpose(0, 1).reshape(CLASSES, -1) for image in pictures], 1)
    mean, std = scores.mean(1), scores.std(1).clamp(min=1e-6)
    body.last.weight.div_(std.reshape(-1, 1, 1, 1))
    bias = (body.last.bias - mean) / std
    body.last.bias.copy_(bias)


NETWORKS = {
    "fast_scnn": (FastScnn, {}),
    "fast_scnn_align": (FastScnn, {"align": True}),
    "fast_scnn_argmax": (FastScnn, {"argmax": True}),
    "fast_scnn_bytes": (FastScnn, {"bytes_last": True}),
    "fast_scnn_nearest": (FastScnn, {"mode": "nearest"}),
    "unet": (UNet, {}),
    "unet_transposed": (lambda: UNet(True), {}),
    "deeplab_mobilenet": (DeepLab, {}),
    "lraspp": (LrAspp, {}),
    "fpn_resnet18": (Fpn, {}),
    "bisenet": (BiSeNet, {}),
    "enet": (ENet, {}),
    "segformer": (SegFormer, {}),
}


def export(name, folder, width, height):
    torch.manual_seed(7)
    make, options = NETWORKS[name]
    body = make()
    calibrate(body, width, height)
    whole = Whole(body, **options).eval()
    is_bytes = options.get("bytes_last", False)
    image = torch.zeros(1, height, width, 3, dtype=torch.uint8) if is_bytes else picture(width, height, 9)
    names = {"input_names": ["image"], "output_names": ["scores"]}
    torch.onnx.export(whole, (image,), str(folder / f"{name}.onnx"), opset_version=17, dynamo=False, **names)
    meaning = "" if is_bytes else f"mean = {list(MEAN)}\nstd = {list(STD)}\n"
    align = "align_corners = true\n" if options.get("align") else ""
    (folder / f"{name}.toml").write_text(f'classes = "cityscapes"\n{meaning}{align}')
    print(name, flush=True)


def main():
    folder = pathlib.Path(sys.argv[1])
    width, height = map(int, sys.argv[2:4] or (512, 256))
    folder.mkdir(parents=True, exist_ok=True)
    torch.set_num_threads(1)
    for name in NETWORKS:
        export(name, folder, width, height)


if __name__ == "__main__":
    main()
