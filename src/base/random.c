// Random numbers for laws and sample points: splitmix64 [SteeleLeaFlood2014]. The same seed
// gives the same numbers everywhere.
#include "base/base.h"

uint64_t pl_random_bits(pl_random* r) {
  uint64_t x = r->state += 0x9e3779b97f4a7c15ull;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ x >> 27) * 0x94d049bb133111ebull;
  return x ^ x >> 31;
}

double pl_random_unit(pl_random* r) { return (double)(pl_random_bits(r) >> 11) * 0x1p-53; }

double pl_random_between(pl_random* r, double lo, double hi) {
  return lo + (hi - lo) * pl_random_unit(r);
}
