import os
import subprocess
import sys
from pathlib import Path

# Opens the window, goes from a surface to a matrix and to a surface of another size, plays, and closes.
SCRIPT = """
import sys
sys.path.insert(0, sys.argv[1])
from conftest import make_products
from reperform.viewer.browser import Results
from reperform.viewer.session import Session
from reperform.viewer.window import Window, open_window

products = make_products()
steps = ["mesh", "matrix", "surfaces", "performance"]
tick, count, seen = Window._tick, 0, set()


def act(window):
    global count
    count += 1
    place = count // 6
    if place > len(steps):
        seen.add(window.session.frame)
    if count % 6 == 0:
        if place < len(steps):
            window.session.select(steps[place])
            window.refresh()
            print(window.session.caption(), flush=True)
        elif place == len(steps):
            window.session.play()
        elif place > len(steps) and (len(seen) > 1 or place == len(steps) + 40):
            print("moved", len(seen) > 1, flush=True)
            # Not from within a tick: Open3D is then walking through its windows.
            window._gui.Application.instance.post_to_main_thread(window.window, window.window.close)
    return tick(window) or True


Window._tick = act
open_window(Session(Results(products, steps), "mesh"), (640, 480))
print("returned", flush=True)
"""


def test_the_window_opens_shows_every_kind_plays_and_closes(display: str) -> None:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT, str(Path(__file__).parent)],
        env={**os.environ, "DISPLAY": display},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    for line in ("matrix", "surfaces, frame 0 of 2", "performance, frame 0 of 12", "moved True", "returned"):
        assert line in done.stdout
