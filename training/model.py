"""The network, in torch: convolutions over frequency, then dilated ones over time (Davies & Böck 2019, smaller).

``causal`` pads on the left only. :mod:`onbeat.music.activation` runs the same arithmetic in numpy.
"""

from __future__ import annotations

import numpy as np
import torch
from torch import nn
from torch.nn import functional

CHANNELS = 24
FIRST, SECOND = 8, 16
DILATIONS = tuple(2**k for k in range(10))


class Activation(nn.Module):
    """Logits of beat and downbeat (batch, frames, 2) from features (batch, 2, frames, 64)."""

    def __init__(self, causal: bool, channels: int = CHANNELS) -> None:
        super().__init__()
        self.causal = causal
        self.first = nn.Conv2d(2, FIRST, (3, 5), (1, 2))
        self.second = nn.Conv2d(FIRST, SECOND, (3, 5), (1, 3))
        self.third = nn.Linear(SECOND * 10, channels)
        self.wide = nn.ModuleList(nn.Conv1d(channels, channels, 5, dilation=d) for d in DILATIONS)
        self.mix = nn.ModuleList(nn.Conv1d(channels, channels, 1) for _ in DILATIONS)
        self.last = nn.Linear(channels, 2)
        self.drop = nn.Dropout1d(0.1)

    def _time(self, x: torch.Tensor, reach: int, axis: int) -> torch.Tensor:
        pad = (reach, 0) if self.causal else (reach // 2, reach // 2)
        return functional.pad(x, (0, 0, *pad) if axis == 2 else pad)

    def forward(self, x: torch.Tensor) -> torch.Tensor:
        """Logits."""
        x = functional.elu(self.first(functional.pad(self._time(x, 2, 2), (2, 2))))
        x = functional.elu(self.second(functional.pad(self._time(x, 2, 2), (1, 1))))
        x = x.permute(0, 2, 1, 3).flatten(2)
        x = functional.elu(self.third(x)).transpose(1, 2)
        for wide, mix, dilation in zip(self.wide, self.mix, DILATIONS, strict=True):
            inner = functional.elu(wide(self._time(x, 4 * dilation, -1)))
            x = x + mix(self.drop(inner))
        return self.last(functional.elu(x).transpose(1, 2))


def weights_of(model: Activation) -> dict[str, np.ndarray]:
    """The weights as the numpy code wants them: every product as (inputs, outputs), taps of time first."""
    state = {name: value.detach().numpy().astype(np.float32) for name, value in model.state_dict().items()}
    result = {
        "first": state["first.weight"].transpose(2, 1, 3, 0).reshape(-1, FIRST),  # (time, channel, frequency), out
        "first_bias": state["first.bias"],
        "second": state["second.weight"].transpose(2, 3, 1, 0).reshape(-1, SECOND),  # (time, frequency, channel), out
        "second_bias": state["second.bias"],
        "third": state["third.weight"]
        .reshape(-1, SECOND, 10)
        .transpose(2, 1, 0)
        .reshape(SECOND * 10, -1),  # (frequency, channel)
        "third_bias": state["third.bias"],
        "wide": np.stack([state[f"wide.{k}.weight"].transpose(2, 1, 0) for k in range(len(DILATIONS))]),
        "wide_bias": np.stack([state[f"wide.{k}.bias"] for k in range(len(DILATIONS))]),
        "mix": np.stack([state[f"mix.{k}.weight"][:, :, 0].T for k in range(len(DILATIONS))]),
        "mix_bias": np.stack([state[f"mix.{k}.bias"] for k in range(len(DILATIONS))]),
        "last": state["last.weight"].T,
        "last_bias": state["last.bias"],
    }
    return {name: np.ascontiguousarray(value) for name, value in result.items()}
