// The shortest decimal that reads back to the same double.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/base.h"

// The decimal point of the locale, whatever it is, becomes a dot.
static int plain_point(char* out, const char* text) {
  int n = 0;
  for (const char* s = text; *s; s++) {
    bool plain = (*s >= '0' && *s <= '9') || *s == '-' || *s == '+' || *s == 'e';
    if (plain) out[n++] = *s;
    else if (n > 0 && out[n - 1] != '.') out[n++] = '.';
  }
  out[n] = '\0';
  return n;
}

int pl_double_text(char out[32], double x) {
  char text[40], shorter[40];
  if (isnan(x)) return (int)strlen(strcpy(out, "nan"));
  if (isinf(x)) return (int)strlen(strcpy(out, x > 0 ? "inf" : "-inf"));
  if (x == 0) return (int)strlen(strcpy(out, "0"));
  snprintf(text, sizeof text, "%.17g", x);
  for (int digits = 16; digits >= 15; digits--) {
    snprintf(shorter, sizeof shorter, "%.*g", digits, x);
    if (strtod(shorter, NULL) != x) break;
    strcpy(text, shorter);
  }
  return plain_point(out, text);
}
