"""Times training steps of the motion diffusion model as they are usually written in PyTorch.

The same networks, batches, optimiser (AdamW), clipping and running average as
`crates/physique-learn/examples/step_time.rs`. Times do not depend on the numbers, so they are made up.

Usage: step_time.py [large|small] [STEPS]      as many threads as RAYON_NUM_THREADS, else all cores
"""

import os
import resource
import sys
import time

import torch

COLUMNS = 263
CASES = {
    "large": dict(width=512, layers=8, batch=64, frames=196, together=1, text=512, small=False),
    "small": dict(width=256, layers=5, batch=16, frames=120, together=2, text=384, small=True),
}


class Mdm(torch.nn.Module):
    """`trans_enc`; the small one normalises first, masks padding and adds the condition to all frames."""

    def __init__(self, width, layers, together, text, small, **_):
        super().__init__()
        self.width, self.together, self.small = width, together, small
        self.pose = torch.nn.Linear(COLUMNS * together, width)
        self.time = torch.nn.Sequential(
            torch.nn.Linear(width, width), torch.nn.SiLU(), torch.nn.Linear(width, width)
        )
        self.text = torch.nn.Linear(text, width)
        layer = torch.nn.TransformerEncoderLayer(
            width, 4, 1024, dropout=0.1, activation="gelu", batch_first=True, norm_first=small
        )
        self.encoder = torch.nn.TransformerEncoder(layer, layers, enable_nested_tensor=False)
        self.final = torch.nn.Linear(width, COLUMNS * together)
        self.dropout = torch.nn.Dropout(0.1)
        positions = torch.arange(5000)[:, None]
        angles = positions * torch.exp(-torch.arange(0, width, 2) * (9.2103404 / width))
        self.register_buffer("places", torch.stack([angles.sin(), angles.cos()], -1).flatten(1))

    def forward(self, noisy, steps, captions):
        batch, frames, _ = noisy.shape
        x = self.pose(noisy.reshape(batch, frames // self.together, -1))
        condition = (self.text(captions) + self.time(self.places[steps]))[:, None]
        if self.small:
            x = x + condition
        x = torch.cat([condition, x], 1)
        x = self.dropout(x + self.places[: x.shape[1]])
        mask = torch.zeros(x.shape[:2], dtype=torch.bool) if self.small else None
        x = self.encoder(x, src_key_padding_mask=mask)[:, 1:]
        return self.final(x).reshape(batch, frames, COLUMNS)


def main():
    torch.manual_seed(0)
    torch.set_num_threads(int(os.environ.get("RAYON_NUM_THREADS", os.cpu_count())))
    name = sys.argv[1] if len(sys.argv) > 1 else "small"
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    case = CASES[name]
    network = Mdm(**case)
    average = [parameter.detach().clone() for parameter in network.parameters()]
    optimiser = torch.optim.AdamW(network.parameters(), lr=1e-4, weight_decay=0.0)
    kept = torch.linspace(0.999, 0.001, 50)
    shape = case["batch"], case["frames"], COLUMNS
    wall, cpu = [], []
    for step in range(count + 1):
        start = time.perf_counter(), time.process_time()
        clean, noise = torch.randn(shape), torch.randn(shape)
        steps = torch.randint(50, (case["batch"],))
        captions = torch.randn(case["batch"], case["text"])
        captions = captions * (torch.rand(case["batch"], 1) >= 0.1)
        share = kept[steps, None, None]
        noisy = share.sqrt() * clean + (1 - share).sqrt() * noise
        within = torch.ones(shape[:2])[..., None]
        squares = (network(noisy, steps, captions) - clean) ** 2 * within
        loss = (squares.sum((1, 2)) / (case["frames"] * COLUMNS)).mean()
        optimiser.zero_grad()
        loss.backward()
        torch.nn.utils.clip_grad_norm_(network.parameters(), 1.0)
        optimiser.step()
        with torch.no_grad():
            torch._foreach_lerp_(average, list(network.parameters()), 0.001)
        loss.item()
        if step > 0:
            wall.append(time.perf_counter() - start[0])
            cpu.append(time.process_time() - start[1])
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(
        f"{name}: PyTorch {torch.__version__}, {torch.get_num_threads()} threads, "
        f"wall {sorted(wall)[len(wall) // 2]:.4f} s, CPU {sum(cpu) / len(cpu):.4f} s a step, "
        f"process {peak:.0f} MiB at most"
    )


if __name__ == "__main__":
    main()
