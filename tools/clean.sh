#!/bin/sh
# Removes what was built.
cd "$(dirname "$0")/.." && rm -rf build build-bench build-test
