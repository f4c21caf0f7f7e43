"""The play window on a virtual screen, under real key presses and a real mouse."""

import os
import pickle
import shutil
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from reperform.nodes.blend.correct_space import correct_space

TITLE = "play window under test"
# Opens the window and tells, whenever it changes, what the hands have done to the session.
SCRIPT = """
import pickle, sys
from pathlib import Path
from reperform.nodes.synthesis.character_data import character_data
from reperform.viewer.play_session import PlaySession
from reperform.viewer.play_window import PlayWindow, play_window

graph, spaces, corrections = pickle.loads(Path(sys.argv[1]).read_bytes())
data = character_data(graph, spaces, corrections, "hybrid")
session = PlaySession(data, (("m/s", "rad/s"), ("m",)))
tick, told = PlayWindow._tick, None


def tell(window):
    global told
    s = window.session
    recorded = s.recording.count if s.recording else 0
    now = (s.number, s.path and len(s.path) > 1, s.pilot is not None, s.is_recording, recorded > 20, s.character.corrected,
           round(s.values[0][0] - s.data.values(0, {})[0], 1))
    if now != told:
        told = now
        keys = ("number", "path", "pilot", "recording", "recorded", "corrected", "faster")
        print(dict(zip(keys, map(bool, now))) | {"number": s.number}, flush=True)
    return tick(window)


PlayWindow._tick = tell
play_window(session, sys.argv[2], size=(900, 600))
print("returned", flush=True)
"""


class Told:
    """The last state that the window told of; `wait(...)` until it is so."""

    def __init__(self, window: subprocess.Popen[str]) -> None:
        self.lines: list[str] = []
        self._window = window
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self._window.stdout is not None
        for line in self._window.stdout:
            self.lines.append(line.strip())

    def wait(self, what: str, limit: float = 60.0) -> None:
        end = time.monotonic() + limit
        while not (self.lines and what in self.lines[-1]):
            over = time.monotonic() > end or self._window.poll() is not None
            assert not over, f"the window never told {what}; it told {self.lines[-8:]}"
            time.sleep(0.1)


def test_hands_press_draw_record_and_close(display: str, playable: tuple, tmp_path: Path) -> None:
    tool = shutil.which("xdotool")
    if tool is None:
        pytest.skip("xdotool is not installed: apt-get install xdotool")
    graph, spaces = playable
    corrections = {"jump": correct_space(spaces["jump"])}
    stored = tmp_path / "playable.pickle"
    stored.write_bytes(pickle.dumps((graph, spaces, corrections)))
    env = {**os.environ, "DISPLAY": display}

    def hands(*words: str) -> str:
        return subprocess.run(
            [tool, *words], env=env, capture_output=True, text=True, timeout=60, check=True
        ).stdout

    with subprocess.Popen(
        [sys.executable, "-c", SCRIPT, str(stored), TITLE], env=env, stdout=subprocess.PIPE, text=True
    ) as window:
        try:
            told = Told(window)
            told.wait("'number': 0")
            name = hands("search", "--sync", "--name", TITLE).split()[0]
            hands("windowfocus", "--sync", name)
            hands("keydown", "Up")
            told.wait("'faster': True")
            hands("keyup", "Up")
            hands("key", "c")
            told.wait("'recording': True")
            # kept down, a key asks once
            hands("keydown", "j")
            told.wait("'number': 1")
            time.sleep(1.0)
            hands("keyup", "j")
            told.wait("'number': 1")
            hands("key", "h")
            told.wait("'corrected': False")
            hands("key", "h")
            told.wait("'corrected': True")
            hands("mousemove", "200", "380", "keydown", "ctrl", "mousedown", "1")
            for step in range(1, 8):
                hands("mousemove", str(200 + 30 * step), str(380 - 12 * step))
            told.wait("'path': True")
            hands("mouseup", "1", "keyup", "ctrl")
            told.wait("'pilot': True")
            hands("key", "x")
            told.wait("'pilot': False")
            told.wait("'recorded': True")
            hands("key", "c")
            told.wait("'recording': False")
            hands("key", "Escape")
            assert window.wait(60) == 0
        finally:
            window.kill()
    assert told.lines[-1] == "returned"
