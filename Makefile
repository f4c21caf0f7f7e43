# Two commands do all the set-up: `make demo` and `make test`.
PYTHON ?= python3
VENV ?= .venv
BIN := $(VENV)/bin
LIBRARIES := libusb-1.0-0 libegl1 libgl1 libgl1-mesa-dri libx11-6 libudev1 libidn2-0 libvulkan1 mesa-vulkan-drivers \
	libosmesa6 xvfb xdotool x11-utils scrot

# uv is several times faster; where it cannot reach an index that pip is set up for, pip does it
comma := ,
install = $(BIN)/uv pip install --quiet --python $(BIN)/python $(1) || $(BIN)/python -m pip install --quiet $(1)

.PHONY: demo test lint environment test-environment system clean

demo: environment ## install, then film, rebuild, align, direct and render the demo actor
	$(BIN)/reperform run quickstart
	@echo
	@echo "The film:      results/quickstart.mp4"
	@echo "The way:       results/quickstart_path.png, results/quickstart_graph.png"
	@echo "Look closer:   $(BIN)/reperform view quickstart render      (needs the libraries of 'make system')"
	@echo "Direct it:     $(BIN)/reperform run quickstart --set distance=5.0"

test: test-environment system lint ## the same set-up, then every check and test
	$(BIN)/python -m pytest -n 2 --dist loadfile

lint:
	$(BIN)/ruff check
	$(BIN)/ruff format --check
	$(BIN)/mypy src

environment: $(VENV)/.installed
test-environment: $(VENV)/.test-installed

$(VENV)/bin/python:
	@$(PYTHON) -c 'import sys; sys.exit(sys.version_info < (3, 11))' || \
		{ echo "Python 3.11 or newer is needed: make PYTHON=/path/to/python3.11 ..."; exit 1; }
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet uv

$(VENV)/.installed: pyproject.toml | $(VENV)/bin/python
	$(call install,--editable .)
	@touch $@

$(VENV)/.test-installed: pyproject.toml | $(VENV)/bin/python
	$(call install,--editable '.[test$(comma)s3$(comma)usd]')
	@touch $@ $(VENV)/.installed

# Only the window and its tests need these; tests that lack them are skipped and say so.
system:
	@if command -v apt-get >/dev/null && [ "$$(id -u)" = 0 ]; then \
		dpkg -s $(LIBRARIES) >/dev/null 2>&1 || { apt-get update -qq && \
		DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $(LIBRARIES) >/dev/null; }; \
	else \
		echo "For the viewer and its tests, install these system libraries (Debian's names): $(LIBRARIES)"; \
	fi

clean:
	rm -rf $(VENV) .reperform results
