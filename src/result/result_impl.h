// Inside of result: from rows to columns, shared by what keeps and what writes them.
#ifndef PL_RESULT_IMPL_H
#define PL_RESULT_IMPL_H

#include "result/result.h"

// The columns of a row on wider numbers as text with all their digits, one after the other.
void pl_result_digits(const pl_setup* s, const pl_row* row, void* user,
                      void (*take)(void* user, const char* text));

#endif
