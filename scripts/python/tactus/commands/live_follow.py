"""A client of the live page without a browser: opens the WebSocket, receives frames and pictures, and counts them.

  tactus live follow URL [--watch NAME]... [--seconds S] [--json FILE]

tactus run --live prints the URL. The client watches NAMEs ("sim_node.work.collision", "TOOL_STATE:force_N.z") and receives pictures.
At the end it prints the numbers of received frames, values and pictures, and of frames that the server dropped because this client was slow.
"""
import argparse
import asyncio
import json
import sys
import time
import urllib.parse

import websockets

from tactus import terminal
from tactus.option_parser import OptionParser

# Values that the page shows first, and the computing time of each node.
USUAL = ["TOOL_STATE:force_N.z", "TOOL_STATE:proxy.position_m.z", "THERMAL_STATE:skin_degC",
         *(f"{node}_node.work.other" for node in ("sim", "haptic", "audio", "visual", "thermal"))]


async def follow(url, names, seconds, counted):
    place = urllib.parse.urlsplit(url)
    address = f"ws://{place.netloc}/ws?{place.query}"
    async with websockets.connect(address, origin=f"http://{place.netloc}", max_size=1 << 24) as socket:
        end = time.monotonic() + seconds
        await socket.send(json.dumps({"t": "watch", "names": names}))
        while (left := end - time.monotonic()) > 0:
            try:
                message = await asyncio.wait_for(socket.recv(), left)
            except asyncio.TimeoutError:
                return
            if isinstance(message, bytes):
                counted["pictures"] += 1
                continue
            said = json.loads(message)
            if said["t"] == "frame":
                counted["frames"] += 1
                counted["values"] += len(said.get("values") or [])
                counted["dropped"] = (said.get("pages") or {}).get("dropped", counted["dropped"])
            elif said["t"] == "reply" and not said.get("good", True):
                terminal.report_refusal(f"follow: {said.get('text')}")


def main(words):
    parser = OptionParser(prog="tactus live follow", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("url", metavar="URL")
    parser.add_argument("--watch", metavar="NAME", action="append", help="a tagged variable or a field; default: the values that a page shows first")
    parser.add_argument("--seconds", type=float, default=10, help="default: 10")
    parser.add_argument("--json", metavar="FILE", help="also writes the counts to FILE")
    options = parser.parse_args(words)
    counted = {"frames": 0, "values": 0, "pictures": 0, "dropped": 0}
    try:
        asyncio.run(follow(options.url, options.watch or USUAL, options.seconds, counted))
    except (OSError, ValueError, websockets.WebSocketException) as error:
        # The run may end before this client; the counts are printed in any case.
        terminal.report_refusal(f"follow: {options.url.split('?')[0]} no longer answers ({error})")
    terminal.show("  ".join(f"{name} {value}" for name, value in counted.items()))
    if options.json:
        with open(options.json, "w", encoding="utf-8") as file:
            json.dump({**counted, "seconds": options.seconds}, file, indent=2)
    return 0 if counted["frames"] else 1

