// Base64, RFC 4648.
#include "base/base.h"

void pl_base64_add(pl_text* out, const void* data, size_t n) {
  static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const unsigned char* b = data;
  for (size_t i = 0; i < n; i += 3) {
    size_t k = n - i < 3 ? n - i : 3;
    uint32_t x = (uint32_t)b[i] << 16 | (k > 1 ? (uint32_t)b[i + 1] << 8 : 0)
                 | (k > 2 ? b[i + 2] : 0u);
    char four[4] = {digit[x >> 18], digit[x >> 12 & 63], k > 1 ? digit[x >> 6 & 63] : '=',
                    k > 2 ? digit[x & 63] : '='};
    pl_text_add_n(out, four, 4);
  }
}
