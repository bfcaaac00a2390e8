// GIF 89a, by the specification of 1990: one palette for all frames, each frame only what changed,
// LZW.
//
// The palette holds the 255 most frequent colours of all frames in steps of 8; entry 255 is
// transparent, for pixels that stay as they were.
#include <stdlib.h>
#include <string.h>

#include "picture/picture_impl.h"

enum { BINS = 1 << 15, COLOURS = 255, CLEAR = 256, END = 257, MOST_CODES = 4096, TABLE = 1 << 13 };

struct pl_gif {
  pl_arena* arena;
  int width, height, delay;  // delay in 1/100 s
  pl_text out;
  uint32_t palette[COLOURS + 1];
  uint8_t* entry;                  // of each bin, plus 1; 0 not looked for yet   (BINS)
  uint8_t *before, *now, *change;  // indices of pixels
  bool first;
};

static int bin_of(uint32_t rgb) {
  return (int)((rgb >> 19 & 31) << 10 | (rgb >> 11 & 31) << 5 | (rgb >> 3 & 31));
}

void pl_gif_count(uint32_t* count, const uint32_t* pixels, size_t n) {
  for (size_t i = 0; i < n; i++) count[bin_of(pixels[i])]++;
}

static void byte(pl_gif* g, int x) {
  char c = (char)x;
  pl_text_add_n(&g->out, &c, 1);
}
static void word(pl_gif* g, int x) {
  byte(g, x & 255);
  byte(g, x >> 8 & 255);
}

static void choose_palette(pl_gif* g, const uint32_t* count) {
  uint32_t* left = PL_ARRAY(g->arena, uint32_t, BINS);
  memcpy(left, count, BINS * sizeof *left);
  for (int k = 0; k < COLOURS; k++) {
    int best = 0;
    for (int i = 1; i < BINS; i++)
      if (left[i] > left[best]) best = i;
    left[best] = 0;
    unsigned r = (unsigned)best >> 10 & 31, gr = (unsigned)best >> 5 & 31, b = (unsigned)best & 31;
    g->palette[k] = (r << 3 | r >> 2) << 16 | (gr << 3 | gr >> 2) << 8 | (b << 3 | b >> 2);
  }
}

pl_gif* pl_gif_make(pl_arena* a, int width, int height, int delay, const uint32_t* count) {
  pl_gif* g = PL_NEW(a, pl_gif);
  *g = (pl_gif){.arena = a,
                .width = width,
                .height = height,
                .delay = delay,
                .out = pl_text_make(a),
                .first = true};
  size_t n = (size_t)width * (size_t)height;
  g->entry = PL_ARRAY(a, uint8_t, BINS);
  g->before = PL_ARRAY(a, uint8_t, n);
  g->now = PL_ARRAY(a, uint8_t, n);
  g->change = PL_ARRAY(a, uint8_t, n);
  choose_palette(g, count);
  pl_text_add(&g->out, "GIF89a");
  word(g, width);
  word(g, height);
  byte(g, 0xf7);  // global palette of 256 colours
  byte(g, 0);
  byte(g, 0);
  for (int k = 0; k <= COLOURS; k++) {
    byte(g, (int)(g->palette[k] >> 16 & 255));
    byte(g, (int)(g->palette[k] >> 8 & 255));
    byte(g, (int)(g->palette[k] & 255));
  }
  byte(g, 0x21);
  byte(g, 0xff);
  byte(g, 11);  // again and again
  pl_text_add(&g->out, "NETSCAPE2.0");
  byte(g, 3);
  byte(g, 1);
  word(g, 0);
  byte(g, 0);
  return g;
}

static int nearest(pl_gif* g, uint32_t rgb) {
  uint8_t* known = &g->entry[bin_of(rgb)];
  if (*known) return *known - 1;
  long least = -1;
  int best = 0;
  for (int k = 0; k < COLOURS - 1; k++) {
    long dr = (long)(rgb >> 16 & 255) - (long)(g->palette[k] >> 16 & 255),
         dg = (long)(rgb >> 8 & 255) - (long)(g->palette[k] >> 8 & 255);
    long db = (long)(rgb & 255) - (long)(g->palette[k] & 255),
         d = 2 * dr * dr + 4 * dg * dg + 3 * db * db;
    if (least < 0 || d < least) {
      least = d;
      best = k;
    }
  }
  *known = (uint8_t)(best + 1);
  return best;
}

// --------------------------------------------------------------------------------------------- LZW
typedef struct pl_lzw {
  pl_gif* g;
  uint8_t block[255];
  int n_block, bits, n_bits, next;
  uint32_t kept;
  int32_t key[TABLE];  // (prefix << 8 | byte) + 1
  int16_t code[TABLE];
} pl_lzw;

static void flush(pl_lzw* z) {
  if (z->n_block == 0) return;
  byte(z->g, z->n_block);
  pl_text_add_n(&z->g->out, (const char*)z->block, (size_t)z->n_block);
  z->n_block = 0;
}

static void put(pl_lzw* z, int code) {
  z->kept |= (uint32_t)code << z->n_bits;
  z->n_bits += z->bits;
  while (z->n_bits >= 8) {
    z->block[z->n_block++] = (uint8_t)(z->kept & 255);
    if (z->n_block == 255) flush(z);
    z->kept >>= 8;
    z->n_bits -= 8;
  }
}

static void restart(pl_lzw* z) {
  put(z, CLEAR);
  memset(z->key, 0, sizeof z->key);
  z->next = END + 1;
  z->bits = 9;
}

static int slot(const pl_lzw* z, int32_t key) {
  unsigned i = (unsigned)key * 2654435761u >> 19;
  while (z->key[i % TABLE] != 0 && z->key[i % TABLE] != key) i++;
  return (int)(i % TABLE);
}

static void compress(pl_gif* g, const uint8_t* data, size_t n) {
  pl_lzw* z = PL_NEW(g->arena, pl_lzw);
  z->g = g;
  z->bits = 9;
  byte(g, 8);
  restart(z);
  int prefix = data[0];
  for (size_t i = 1; i < n; i++) {
    int32_t key = (prefix << 8 | data[i]) + 1;
    int at = slot(z, key);
    if (z->key[at] == key) {
      prefix = z->code[at];
      continue;
    }
    put(z, prefix);
    if (z->next < MOST_CODES) {
      z->key[at] = key;
      z->code[at] = (int16_t)z->next++;
      if (z->next > 1 << z->bits && z->bits < 12) z->bits++;
    } else {
      restart(z);
    }
    prefix = data[i];
  }
  put(z, prefix);
  put(z, END);
  if (z->n_bits > 0) z->block[z->n_block++] = (uint8_t)(z->kept & 255);
  flush(z);
  byte(g, 0);
}

void pl_gif_frame(pl_gif* g, const uint32_t* pixels) {
  size_t n = (size_t)g->width * (size_t)g->height;
  int top = g->height, bottom = -1;
  for (size_t i = 0; i < n; i++) {
    g->now[i] = (uint8_t)nearest(g, pixels[i]);
    bool same = !g->first && g->now[i] == g->before[i];
    g->change[i] = same ? COLOURS : g->now[i];
    int row = (int)(i / (size_t)g->width);
    if (!same && row < top) top = row;
    if (!same) bottom = row;
  }
  if (bottom < 0) top = bottom = 0;
  byte(g, 0x21);
  byte(g, 0xf9);
  byte(g, 4);
  byte(g, 1 << 2 | 1);  // what was drawn stays; there is a transparent colour
  word(g, g->delay);
  byte(g, COLOURS);
  byte(g, 0);
  byte(g, 0x2c);
  word(g, 0);
  word(g, top);
  word(g, g->width);
  word(g, bottom - top + 1);
  byte(g, 0);
  compress(g, g->change + (size_t)top * (size_t)g->width,
           (size_t)(bottom - top + 1) * (size_t)g->width);
  uint8_t* swap = g->before;
  g->before = g->now;
  g->now = swap;
  g->first = false;
}

const char* pl_gif_end(pl_gif* g, size_t* n) {
  byte(g, 0x3b);
  *n = g->out.n;
  return g->out.at;
}
