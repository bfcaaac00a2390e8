# The front door.  Every rule is one line; the work is done in tools/ and by meson.
#
#   make            build the program: build/pleuel
#   make demo       solve and simulate a model, and say what was written where
#   make test       build with all checks on and run every test
#   make format     lay the sources out as .clang-format says
#   make bench      time the program on the examples
#   make install    into PREFIX (default /usr/local), below DESTDIR if that is given
#   make clean      remove what was built
PREFIX ?= /usr/local
export DESTDIR

.PHONY: all demo test bench format install clean
all:     ; @tools/build.sh
demo:    ; @tools/demo.sh
test:    ; @tools/test.sh
bench:   ; @tools/bench.sh
format:  ; @tools/format.sh
install: ; @tools/install.sh "$(PREFIX)"
clean:   ; @tools/clean.sh
