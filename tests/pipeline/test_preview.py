#!/usr/bin/env python3
"""vpl-render --preview: every packet that a viewer gets, and viewers that come and go.

tests/pipeline/test_preview.py build/release/bin
"""

import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "python"))
import bnvpl  # noqa: E402

BIN = Path("build/release/bin")
SCENE = SOURCE / "scenes/cornell/scene.toml"
WIDTH, HEIGHT = 100, 70  # neither is a multiple of a block
CLOSE, CREATE, UPDATE = 2, 4, 6


class Fields:
    """Reads the fields of a packet one after the other."""

    def __init__(self, packet: bytes) -> None:
        self.packet, self.at = packet, 5

    def take(self, layout: str) -> tuple[int, ...]:
        values = struct.unpack_from("<" + layout, self.packet, self.at)
        self.at += struct.calcsize("<" + layout)
        return values

    def text(self) -> str:
        end = self.packet.index(0, self.at)
        text, self.at = self.packet[self.at : end].decode(), end + 1
        return text


class Viewer:
    """Accepts connections in turn; from each but the last it goes away after `packets`."""

    def __init__(self, leave_after: int = 0) -> None:
        self.socket = socket.create_server(("127.0.0.1", 0))
        self.port = self.socket.getsockname()[1]
        self.leave_after = leave_after
        self.visits: list[list[bytes]] = []
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self) -> None:
        for limit in (self.leave_after, 0) if self.leave_after else (0,):
            connection, _ = self.socket.accept()
            self.visits.append([])
            with connection:
                self.read(connection, limit)

    def read(self, connection: socket.socket, limit: int) -> None:
        data = b""
        while not limit or len(self.visits[-1]) < limit:
            got = connection.recv(1 << 16)
            if not got:
                assert not data, "half a packet"
                return
            data += got
            while len(data) >= 4 and len(data) >= (size := struct.unpack("<I", data[:4])[0]):
                self.visits[-1].append(data[:size])
                data = data[size:]


class Preview(unittest.TestCase):
    def setUp(self) -> None:
        holder = tempfile.TemporaryDirectory(prefix="bnvpl-preview-")
        self.addCleanup(holder.cleanup)
        self.image = Path(holder.name) / "image.exr"

    def viewer(self, leave_after: int = 0) -> Viewer:
        viewer = Viewer(leave_after)
        self.addCleanup(viewer.socket.close)
        return viewer

    def render(self, port: int, *more: str, integrator: str = "path", address: str = "") -> str:
        command = [BIN / "vpl-render", SCENE, "-o", self.image, "--integrator", integrator]
        if "--size" not in more:
            command += ["--size", f"{WIDTH}x{HEIGHT}"]
        command += ["--preview", address or f"127.0.0.1:{port}", *more]
        words = [str(word) for word in command]
        return subprocess.run(words, check=True, text=True, capture_output=True).stdout

    def film_of(self, packets: list[bytes]) -> list[float]:
        """Checks the packets of a visit. Returns R, G, B of the film as they leave it."""
        name = str(self.image)
        self.assertEqual([p[4] for p in packets[:2]], [CLOSE, CREATE])
        self.assertEqual(Fields(packets[0]).text(), name)
        create = Fields(packets[1])
        self.assertEqual(create.take("?"), (False,))
        self.assertEqual(create.text(), name)
        self.assertEqual(create.take("iii"), (WIDTH, HEIGHT, 3))
        self.assertEqual([create.text() for _ in range(3)], ["R", "G", "B"])
        self.assertEqual(create.at, len(packets[1]))
        film = [0.0] * (3 * WIDTH * HEIGHT)
        for packet in packets[2:]:
            self.assertEqual(packet[4], UPDATE)
            update = Fields(packet)
            self.assertEqual(update.take("?"), (False,))
            self.assertEqual(update.text(), name)
            self.assertEqual(update.take("i"), (3,))
            self.assertEqual([update.text() for _ in range(3)], ["R", "G", "B"])
            x, y, width, height = update.take("iiii")
            self.assertEqual((x % 64, y % 64), (0, 0))
            self.assertEqual((width, height), (min(64, WIDTH - x), min(64, HEIGHT - y)))
            self.assertEqual(update.take("qqq"), (0, 1, 2))
            self.assertEqual(update.take("qqq"), (3, 3, 3))
            pixels = update.take(f"{3 * width * height}f")
            self.assertEqual(update.at, len(packet))
            for row in range(height):
                to = 3 * ((y + row) * WIDTH + x)
                film[to : to + 3 * width] = pixels[3 * row * width : 3 * (row + 1) * width]
        return film

    def expect_image(self, film: list[float]) -> None:
        self.assertEqual(film, bnvpl.read_exr(self.image).layers["RGB"].ravel().tolist())

    def test_the_film_at_the_end_is_the_image(self) -> None:
        runs = (("path", "--spp", "128"), ("path", "--passes", "4"), ("light", "--spp", "4"))
        for integrator, *options in runs:
            viewer = self.viewer()
            out = self.render(viewer.port, *options, integrator=integrator)
            viewer.thread.join(20)
            self.assertIn("shown by the viewer", out)
            self.expect_image(self.film_of(viewer.visits[0]))

    def test_it_shows_the_film_before_the_end(self) -> None:
        viewer = self.viewer()
        self.render(viewer.port, "--spp", "256", "--threads", "2")
        viewer.thread.join(20)
        updates = len(viewer.visits[0]) - 2
        self.assertGreater(updates, 8)  # four blocks at the end

    def test_a_viewer_that_comes_back_gets_all(self) -> None:
        viewer = self.viewer(leave_after=4)
        self.render(viewer.port, "--spp", "512", "--threads", "2")
        viewer.thread.join(20)
        self.assertEqual(len(viewer.visits), 2)
        self.expect_image(self.film_of(viewer.visits[1]))

    def test_without_a_viewer_it_renders(self) -> None:
        with socket.create_server(("127.0.0.1", 0)) as closed:
            port = closed.getsockname()[1]
        self.assertIn("no viewer was at", self.render(port, "--spp", "1"))
        self.assertTrue(self.image.exists())

    def test_a_viewer_that_does_not_read_is_said_to_lack_the_image(self) -> None:
        with socket.socket() as deaf:
            deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
            deaf.bind(("127.0.0.1", 0))
            deaf.listen()
            port = deaf.getsockname()[1]
            started = time.monotonic()
            out = self.render(port, "--spp", "1", "--size", "1024x1024")
            self.assertIn("but not the whole image", out)
            self.assertNotIn("shown by", out)
            self.assertLess(time.monotonic() - started, 60)
        self.assertTrue(self.image.exists())

    def test_addresses_of_version_6_keep_their_brackets(self) -> None:
        out = self.render(0, "--spp", "1", address="[::1]:9")
        self.assertIn("no viewer was at [::1]:9;", out)

    def test_addresses(self) -> None:
        for address in ("localhost:0", "localhost:99999", "a:b", ":1", "[::1"):
            command = [BIN / "vpl-render", SCENE, "-o", self.image, "--integrator", "path"]
            words = [str(word) for word in [*command, "--preview", address]]
            done = subprocess.run(words, text=True, capture_output=True, check=False)
            self.assertEqual(done.returncode, 2, address)
            self.assertIn("--preview '", done.stderr)
            self.assertFalse(self.image.exists())


if __name__ == "__main__":
    if len(sys.argv) > 1:
        BIN = Path(sys.argv.pop(1)).resolve()
    unittest.main()
