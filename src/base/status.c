// Status: how a computation ended, and the sentence with numbers that goes with it.
#include "base/base.h"

#include <string.h>

const char* pleuel_status_name(pleuel_status s) {
  switch (s) {
    case PLEUEL_OK: return "PLEUEL_OK";
    case PLEUEL_EXPECT_FAILED: return "PLEUEL_EXPECT_FAILED";
    case PLEUEL_USAGE: return "PLEUEL_USAGE";
    case PLEUEL_MODEL_ERROR: return "PLEUEL_MODEL_ERROR";
    case PLEUEL_CONTRADICTION: return "PLEUEL_CONTRADICTION";
    case PLEUEL_NO_CLOSED_FORM: return "PLEUEL_NO_CLOSED_FORM";
    case PLEUEL_NUMERICAL: return "PLEUEL_NUMERICAL";
    case PLEUEL_SINGULAR: return "PLEUEL_SINGULAR";
    case PLEUEL_FILE: return "PLEUEL_FILE";
    case PLEUEL_INTERRUPTED: return "PLEUEL_INTERRUPTED";
    case PLEUEL_NO_MEMORY: return "PLEUEL_NO_MEMORY";
    case PLEUEL_UNSUPPORTED: return "PLEUEL_UNSUPPORTED";
  }
  return "unknown status";
}

const char* pl_in_language(pl_language lang, const char* sentence) {
  return lang == PL_GERMAN ? pl_german(sentence) : sentence;
}

pleuel_status pl_fail(pl_job* job, pleuel_status s, const char* fmt, ...) {
  va_list ap;
  va_start(ap, fmt);
  vsnprintf(job->message, sizeof job->message, pl_in_language(job->lang, fmt), ap);
  va_end(ap);
  job->status = s;
  return s;
}
