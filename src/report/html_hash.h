// html_hash: SHA-256 and base64 for the HTML report.
#ifndef PL_HTML_HASH_H
#define PL_HTML_HASH_H

#include "base/base.h"

void pl_html_sha256(unsigned char out[32], const char* s, size_t n);
const char* pl_html_hex(pl_arena* a, const unsigned char* b, size_t n);
void pl_html_base64(pl_text* out, const void* data, size_t n);

#endif
