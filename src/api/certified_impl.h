// What was proved of a run, in numbers of its columns: certified.c fills it, certified_words.c
// tells it.
#ifndef PL_CERTIFIED_IMPL_H
#define PL_CERTIFIED_IMPL_H

#include "api/api_impl.h"
#include "enclose/enclose.h"

// Why nothing was tried.
typedef enum pl_certify_refusal {
  PL_CERTIFY_TRIED,
  PL_REFUSED_RUN,  // the run itself did not reach its end
  PL_REFUSED_FRICTION,
  // events that change the motion otherwise than by releasing a constraint
  PL_REFUSED_EVENT,
  PL_REFUSED_BACKWARD,  // contacts or events, backwards in time
  PL_REFUSED_TURN,      // attitudes integrated as quaternions
  PL_REFUSED_SENSITIVITIES,
  PL_REFUSED_ROWS,  // too many rows
  PL_N_REFUSALS
} pl_certify_refusal;

typedef struct pl_certified_value {
  const char* text;     // decimal number; NULL: not determined
  double radius;        // the true value is within it
  double error, least;  // bounds of how far the run is from the true value; NaN without a row
} pl_certified_value;

typedef struct pl_certificate_of_run {
  pl_certify_refusal refusal;
  const char* refused_name;
  pl_certified proof;            // without its balls
  int n_q, n_c, n_times;         // times: that were asked for
  double* time;                  // rounded                                   (n_times)
  pl_certified_value* value;     // q, v, λ of each time done   (n_done x (2 n_q + n_c))
  pl_certified_value* happened;  // times of what happened           (n_happened)
  pl_certified_value* state;     // q, v then                        (n_happened x 2 n_q)
  // the start of the run
  double *q_run, *v_run;
  bool *active, *implied;
} pl_certificate_of_run;

#endif
