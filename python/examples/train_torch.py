"""Trains a small network on corner cases with a plain loop of PyTorch.

Usage: python train_torch.py FOLDER_OF_CASES (needs PyTorch)
"""

import sys

import aeye
import torch
from aeye.datasets import CornerCases
from torch.utils.data import DataLoader


def sample(frame: aeye.Frame) -> tuple[torch.Tensor, torch.Tensor]:
    """A picture in [0, 1], of shape (3, height, width), and the class of each pixel."""
    return torch.from_numpy(frame.rgb).permute(2, 0, 1) / 255, torch.from_numpy(frame.class_ids).long()


def main() -> None:
    cases = CornerCases(sys.argv[1], size=(128, 64), transform=sample)
    loader = DataLoader(cases, batch_size=8, shuffle=True)
    network = torch.nn.Sequential(
        torch.nn.Conv2d(3, 16, 5, padding=2),
        torch.nn.ReLU(),
        torch.nn.Conv2d(16, 16, 5, padding=2),
        torch.nn.ReLU(),
        torch.nn.Conv2d(16, len(aeye.CLASSES), 1),
    )
    optimizer = torch.optim.Adam(network.parameters(), lr=1e-2)
    for epoch in range(3):
        total = 0.0
        for rgb, class_ids in loader:
            loss = torch.nn.functional.cross_entropy(network(rgb), class_ids)
            optimizer.zero_grad()
            loss.backward()
            optimizer.step()
            total += loss.item() * len(rgb)
        print(f"epoch {epoch + 1}: loss {total / len(cases):.3f}")


if __name__ == "__main__":
    main()
