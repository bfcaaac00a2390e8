// SUNDIALS.  Usage: peer_sundials METHOD TOLERANCE END
//   adams, bdf   CVODE on the reduced equations: fixed-point iteration; Newton with the analytic
// Jacobian, dense up to 100
//                unknowns, above that GMRES without a matrix
//   erk8         ARKODE's explicit method of the highest order, Fehlberg 13-7-8, on the same
// equations
//   ida          IDA on the stabilised index-2 form (Gear, Gupta, Leimkuhler), analytic Jacobian,
// dense up to 100 unknowns,
//                above that sparse (KLU); multipliers out of the error test and with wide weights,
// as its users do
#include "peer_common.h"

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_config.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#ifdef WITH_KLU
#  include <sunlinsol/sunlinsol_klu.h>
#  include <sunmatrix/sunmatrix_sparse.h>
#endif

enum { DENSE_UP_TO = 100 };

static double tolerance, end;
static SUNContext context;

static int right_side(double t, N_Vector y, N_Vector f, void* user) {
  (void)user;
  slope(t, N_VGetArrayPointer(y), N_VGetArrayPointer(f));
  return 0;
}

#ifndef WITHOUT_JACOBIAN
static int right_side_jacobian(double t, N_Vector y, N_Vector f, SUNMatrix J, void* user,
                               N_Vector a, N_Vector b, N_Vector c) {
  (void)user;
  (void)f;
  (void)a;
  (void)b;
  (void)c;
  double* data = SUNDenseMatrix_Data(J);
  memset(data, 0, (size_t)N_Y * N_Y * sizeof(double));
  jacobian(t, N_VGetArrayPointer(y), data);
  return 0;
}
#endif

static long with_cvode(double* us, double* out, int method) {
  N_Vector y = N_VNew_Serial(N_Y, context);
  start(N_VGetArrayPointer(y));
  void* mem = CVodeCreate(method, context);
  SUNMatrix A = NULL;
  SUNLinearSolver linear = NULL;
  SUNNonlinearSolver fixed = NULL;
  CVodeInit(mem, right_side, 0, y);
  CVodeSStolerances(mem, tolerance, tolerance);
  CVodeSetMaxNumSteps(mem, 100000000);
  CVodeSetStopTime(mem, end);
  if (method == CV_ADAMS) {
    fixed = SUNNonlinSol_FixedPoint(y, 0, context);
    CVodeSetNonlinearSolver(mem, fixed);
  } else {
#ifndef WITHOUT_JACOBIAN
    A = SUNDenseMatrix(N_Y, N_Y, context);
    linear = SUNLinSol_Dense(y, A, context);
    CVodeSetLinearSolver(mem, linear, A);
    CVodeSetJacFn(mem, right_side_jacobian);
#else
    linear = SUNLinSol_SPGMR(y, SUN_PREC_NONE, 0, context);
    CVodeSetLinearSolver(mem, linear, NULL);
#endif
  }
  double t;
  double begin = cpu_us();
  int flag = CVode(mem, end, y, &t, CV_NORMAL);
  *us = cpu_us() - begin;
  long steps = -1;
  if (flag >= 0) CVodeGetNumSteps(mem, &steps);
  memcpy(out, N_VGetArrayPointer(y), N_Y * sizeof(double));
  CVodeFree(&mem);
  if (linear) SUNLinSolFree(linear);
  if (A) SUNMatDestroy(A);
  if (fixed) SUNNonlinSolFree(fixed);
  N_VDestroy(y);
  return steps;
}

static long once_adams(double* us, double* y) { return with_cvode(us, y, CV_ADAMS); }
static long once_bdf(double* us, double* y) { return with_cvode(us, y, CV_BDF); }

static long once_erk(double* us, double* out) {
  N_Vector y = N_VNew_Serial(N_Y, context);
  start(N_VGetArrayPointer(y));
  void* mem = ERKStepCreate(right_side, 0, y, context);
  ERKStepSetTableNum(mem, ARKODE_FEHLBERG_13_7_8);
  ERKStepSStolerances(mem, tolerance, tolerance);
  ERKStepSetMaxNumSteps(mem, 100000000);
  ERKStepSetStopTime(mem, end);
  double t;
  double begin = cpu_us();
  int flag = ERKStepEvolve(mem, end, y, &t, ARK_NORMAL);
  *us = cpu_us() - begin;
  long steps = -1;
  if (flag >= 0) ERKStepGetNumSteps(mem, &steps);
  memcpy(out, N_VGetArrayPointer(y), N_Y * sizeof(double));
  ERKStepFree(&mem);
  N_VDestroy(y);
  return steps;
}

// ----------------------------------------------------------------------------------------------
// IDA
static int residual(double t, N_Vector y, N_Vector yp, N_Vector r, void* user) {
  (void)user;
  ggl_residual(t, N_VGetArrayPointer(y), N_VGetArrayPointer(yp), N_VGetArrayPointer(r));
  return 0;
}

static int residual_jacobian(double t, double cj, N_Vector y, N_Vector yp, N_Vector r, SUNMatrix J,
                             void* user, N_Vector a, N_Vector b, N_Vector c) {
  (void)r;
  (void)user;
  (void)a;
  (void)b;
  (void)c;
  const double *u = N_VGetArrayPointer(y), *up = N_VGetArrayPointer(yp);
#ifdef WITH_KLU
  if (N_GGL > DENSE_UP_TO) {
    ggl_jacobian(t, cj, u, up, SUNSparseMatrix_Data(J));
    for (int j = 0; j <= N_GGL; j++) SUNSparseMatrix_IndexPointers(J)[j] = ggl_columns[j];
    for (int k = 0; k < N_ENTRIES; k++) SUNSparseMatrix_IndexValues(J)[k] = ggl_rows[k];
    return 0;
  }
#endif
  static double entries[N_ENTRIES];
  ggl_jacobian(t, cj, u, up, entries);
  double* data = SUNDenseMatrix_Data(J);
  memset(data, 0, (size_t)N_GGL * N_GGL * sizeof(double));
  for (int j = 0; j < N_GGL; j++)
    for (int k = ggl_columns[j]; k < ggl_columns[j + 1]; k++)
      data[j * N_GGL + ggl_rows[k]] = entries[k];
  return 0;
}

static long once_ida(double* us, double* out) {
  N_Vector y = N_VNew_Serial(N_GGL, context), yp = N_VClone(y), id = N_VClone(y),
           weight = N_VClone(y);
  double *u = N_VGetArrayPointer(y), *up = N_VGetArrayPointer(yp);
  N_VConst(0, y);
  N_VConst(0, yp);
  start(u);
  double lambda[N_C + 1];
  memcpy(up, u + N_Q, N_Q * sizeof(double));
  accelerations(0, u, up + N_Q, lambda);
  for (int c = 0; c < N_C; c++) u[N_Y + c] = lambda[c];
  for (int i = 0; i < N_GGL; i++) {
    N_VGetArrayPointer(id)[i] = i < N_Y;
    N_VGetArrayPointer(weight)[i] = i < N_Y ? tolerance : 1e3;
  }
  void* mem = IDACreate(context);
  IDAInit(mem, residual, 0, y, yp);
  IDASVtolerances(mem, tolerance, weight);
  IDASetId(mem, id);
  IDASetSuppressAlg(mem, SUNTRUE);
  IDASetMaxNumSteps(mem, 100000000);
  IDASetStopTime(mem, end);
  SUNMatrix A;
  SUNLinearSolver linear;
#ifdef WITH_KLU
  if (N_GGL > DENSE_UP_TO) {
    A = SUNSparseMatrix(N_GGL, N_GGL, N_ENTRIES, CSC_MAT, context);
    linear = SUNLinSol_KLU(y, A, context);
  } else
#endif
  {
    A = SUNDenseMatrix(N_GGL, N_GGL, context);
    linear = SUNLinSol_Dense(y, A, context);
  }
  IDASetLinearSolver(mem, linear, A);
  IDASetJacFn(mem, residual_jacobian);
  double t;
  double begin = cpu_us();
  int flag = IDASolve(mem, end, &t, y, yp, IDA_NORMAL);
  *us = cpu_us() - begin;
  long steps = -1;
  if (flag >= 0) IDAGetNumSteps(mem, &steps);
  memcpy(out, u, N_Y * sizeof(double));
  IDAFree(&mem);
  SUNLinSolFree(linear);
  SUNMatDestroy(A);
  N_VDestroy(y);
  N_VDestroy(yp);
  N_VDestroy(id);
  N_VDestroy(weight);
  return steps;
}

int main(int argc, char** argv) {
  if (argc < 4) return 1;
#if SUNDIALS_VERSION_MAJOR >= 7
  SUNContext_Create(SUN_COMM_NULL, &context);
#else
  SUNContext_Create(NULL, &context);
#endif
  tolerance = atof(argv[2]);
  end = atof(argv[3]);
  if (!freopen("/dev/null", "w", stderr)) return 1;
  const char* method = argv[1];
  return strcmp(method, "adams") == 0  ? report(once_adams)
         : strcmp(method, "bdf") == 0  ? report(once_bdf)
         : strcmp(method, "erk8") == 0 ? report(once_erk)
         : strcmp(method, "ida") == 0  ? report(once_ida)
                                       : 1;
}
