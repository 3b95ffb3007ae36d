#!/usr/bin/env bash
# Looks for new failing examples: every test that Hypothesis gives examples to, at random, over and over.
#   tests/random.sh [MINUTES] [pytest's options]      10 minutes unless given; ends with the first failure
# Make what it finds an @example of its test: the ordinary run has the same examples every time.
set -euo pipefail
cd "$(dirname "$0")/.."
minutes=${1:-10}
shift || true
end=$((SECONDS + minutes * 60)) rounds=0
while [ $rounds = 0 ] || [ $SECONDS -lt $end ]; do
    rounds=$((rounds + 1))
    echo "round $rounds, $((SECONDS / 60)) of $minutes minutes"
    pytest --hypothesis-profile random -m hypothesis "$@"
done
echo "no new failing example in $rounds rounds"
