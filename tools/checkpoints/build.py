"""Writes tiny motion diffusion models in every layout that published checkpoints have.

The numbers are made up; `expected.npz` holds what PyTorch's own transformer and GRU make of them.
`build.py --output FOLDER`
"""

import argparse
import json
import math
from collections import OrderedDict
from pathlib import Path

import numpy as np
import torch
from torch import nn

COLUMNS, WIDTH, HEADS, INNER, LAYERS, TEXT, FRAMES = 6, 8, 4, 12, 2, 5, 7


class Named(nn.Module):
    """A module under the attribute names that published files have."""

    def __init__(self, **modules):
        super().__init__()
        for name, module in modules.items():
            self.add_module(name, module)


class Positions(nn.Module):
    def __init__(self, rows):
        super().__init__()
        angles = torch.arange(rows)[:, None] * torch.exp(
            torch.arange(0, WIDTH, 2) * (-math.log(10000.0) / WIDTH)
        )
        pe = torch.zeros(rows, WIDTH)
        pe[:, 0::2], pe[:, 1::2] = torch.sin(angles), torch.cos(angles)
        self.register_buffer("pe", pe[:, None])


class Mdm(nn.Module):
    def __init__(self):
        super().__init__()
        layer = nn.TransformerEncoderLayer(WIDTH, HEADS, INNER, 0.1, "gelu")
        self.input_process = Named(poseEmbedding=nn.Linear(COLUMNS, WIDTH))
        self.sequence_pos_encoder = Positions(50)
        self.seqTransEncoder = nn.TransformerEncoder(layer, LAYERS)
        time = nn.Sequential(nn.Linear(WIDTH, WIDTH), nn.SiLU(), nn.Linear(WIDTH, WIDTH))
        self.embed_timestep = Named(
            sequence_pos_encoder=self.sequence_pos_encoder, time_embed=time
        )
        self.embed_text = nn.Linear(TEXT, WIDTH)
        self.output_process = Named(poseFinal=nn.Linear(WIDTH, COLUMNS))
        self.clip_model = nn.Linear(3, 2)

    def forward(self, x, steps, text):
        pe = self.sequence_pos_encoder.pe
        token = self.embed_text(text) + self.embed_timestep.time_embed(pe[steps, 0])
        x = torch.cat([token[None], self.input_process.poseEmbedding(x.transpose(0, 1))])
        x = self.seqTransEncoder(x + pe[: len(x)])[1:]
        return self.output_process.poseFinal(x).transpose(0, 1)


class MdmGru(Mdm):
    """`--arch gru`: frames beside the condition, and a GRU that is told that frames come second where
    they come first, so that it walks over the batch."""

    def __init__(self):
        super().__init__()
        del self.seqTransEncoder
        self.input_process = Named(poseEmbedding=nn.Linear(COLUMNS + WIDTH, WIDTH))
        self.gru = nn.GRU(WIDTH, WIDTH, num_layers=LAYERS, batch_first=True)

    def forward(self, x, steps, text, over_batch):
        pe = self.sequence_pos_encoder.pe
        token = self.embed_text(text) + self.embed_timestep.time_embed(pe[steps, 0])
        x = x.transpose(0, 1)
        x = torch.cat([x, token[None].expand(len(x), -1, -1)], dim=2)
        x = self.input_process.poseEmbedding(x)
        x = x + pe[: len(x)]
        if over_batch:
            x = self.gru(x)[0]
        else:
            x = self.gru(x.transpose(0, 1))[0].transpose(0, 1)
        return self.output_process.poseFinal(x).transpose(0, 1)


class MdmPlanner(Mdm):
    """`--arch trans_dec` on the vectors of tokens, with clean frames in front of the noisy ones."""

    def __init__(self):
        super().__init__()
        del self.seqTransEncoder
        layer = nn.TransformerDecoderLayer(WIDTH, HEADS, INNER, 0.1, "gelu")
        self.seqTransDecoder = nn.TransformerDecoder(layer, LAYERS)

    def forward(self, context, x, steps, tokens, hidden_tokens, lengths):
        pe = self.sequence_pos_encoder.pe
        time = self.embed_timestep.time_embed(pe[steps, 0])
        memory = self.embed_text(tokens.transpose(0, 1)) + time[None]
        x = torch.cat([context, x], dim=1).transpose(0, 1)
        x = self.input_process.poseEmbedding(x)
        x = x + pe[: len(x)]
        seen = torch.arange(len(x))[None] < (lengths + context.shape[1])[:, None]
        x = self.seqTransDecoder(
            x, memory, memory_key_padding_mask=hidden_tokens, tgt_key_padding_mask=~seen
        )
        return self.output_process.poseFinal(x[context.shape[1] :]).transpose(0, 1)


def made_up(model):
    model = model.eval()
    for parameter in model.parameters():
        nn.init.normal_(parameter, std=0.4)
    return model


def flat_state(model):
    state = model.state_dict()
    return OrderedDict((k, v) for k, v in state.items() if not k.startswith("clip_model."))


def others(output, steps):
    """The GRU and the planner, each in a folder of its own."""
    x, text = torch.randn(3, FRAMES, COLUMNS), torch.randn(3, TEXT)
    gru, planner = made_up(MdmGru()), made_up(MdmPlanner())
    context, tokens = torch.randn(3, 3, COLUMNS), torch.randn(3, 4, TEXT)
    hidden, lengths = torch.zeros(3, 4, dtype=torch.bool), torch.tensor([FRAMES, FRAMES - 2, 1])
    hidden[1, 2:] = True
    with torch.no_grad():
        expected = {
            "x": x,
            "text": text,
            "context": context,
            "tokens": tokens,
            "gru_over_batch": gru(x, steps, text, True),
            "gru_over_frames": gru(x, steps, text, False),
            "planned": planner(context, x, steps, tokens, hidden, lengths),
        }
    np.savez(output / "expected_others.npz", **{k: v.numpy() for k, v in expected.items()})
    for name, model, arguments in (
        ("gru", gru, {"arch": "gru"}),
        (
            "planner",
            planner,
            {
                "arch": "trans_dec",
                "text_encoder_type": "bert",
                "mask_frames": True,
                "diffusion_steps": 10,
                "context_len": 3,
                "pred_len": FRAMES,
            },
        ),
    ):
        folder = output / name
        folder.mkdir(exist_ok=True)
        torch.save(flat_state(model), folder / "model.pt")
        arguments = {"dataset": "humanml", "diffusion_steps": 50} | arguments
        (folder / "args.json").write_text(json.dumps(arguments))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--output", type=Path, required=True)
    output = parser.parse_args().output
    output.mkdir(parents=True, exist_ok=True)
    torch.manual_seed(1)
    model, other = Mdm().eval(), Mdm().eval()
    for module in (model, other):
        for parameter in module.parameters():
            nn.init.normal_(parameter, std=0.4)
    x, text = torch.randn(2, FRAMES, COLUMNS), torch.randn(2, TEXT)
    with torch.no_grad():
        predicted = model(x, torch.tensor([3, 41]), text)
    np.savez(
        output / "expected.npz",
        x=x.numpy(),
        text=text.numpy(),
        predicted=predicted.numpy(),
    )
    arguments = {"dataset": "humanml", "arch": "trans_enc", "diffusion_steps": 50, "lr": 1e-4}
    (output / "args.json").write_text(json.dumps(arguments))

    with_clip = model.state_dict()
    flat = OrderedDict((k, v) for k, v in with_clip.items() if not k.startswith("clip_model."))
    torch.save(flat, output / "flat.pt")
    torch.save(flat, output / "legacy.pt", _use_new_zipfile_serialization=False)
    torch.save(with_clip, output / "with_clip.pt")
    without_tables = OrderedDict((k, v) for k, v in flat.items() if not k.endswith(".pe"))
    torch.save(without_tables, output / "without_tables.pt")
    # As newer versions write it: parameters, not tensors.
    kept = dict(model.named_parameters())
    parameters = OrderedDict((k, kept.get(k, v)) for k, v in flat.items())
    torch.save(parameters, output / "parameters.pt")
    # The running average is what is sampled; the model beside it holds other numbers.
    wrong = OrderedDict((k, v) for k, v in other.state_dict().items() if k in flat)
    torch.save({"model": wrong, "model_avg": flat}, output / "average.pt")
    broken = OrderedDict(flat)
    broken["embed_txt.weight"] = broken.pop("embed_text.weight")
    torch.save(broken, output / "misnamed.pt")
    others(output, torch.tensor([3, 41, 0]))


if __name__ == "__main__":
    main()
