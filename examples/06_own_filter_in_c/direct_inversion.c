/* A filter as an FMU in plain C, without the FMI headers: it inverts the newest LiDAR measurement and differences two of them.
   modelDescription.xml beside it says which variable has which number. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Places of the Reals; the numbers are the value references. */
enum { TIME, RANGE, AZIMUTH, ELEVATION, DCM = 4, R = 13, V = 16, REALS = 19 };

typedef struct {
  double real[REALS];
  double epoch;
  int count, used, valid;
} Filter;

enum { OK = 0, FAILED = 3 };

static void estimate(Filter *f) {
  double x = tan(f->real[AZIMUTH]), y = tan(f->real[ELEVATION]);
  double depth = f->real[RANGE] / sqrt(1.0 + x * x + y * y);
  /* LiDAR axes in body axes: x_L = z_B, y_L = x_B, z_L = y_B. */
  double body[3] = {depth * y, depth, depth * x};
  double dt = f->real[TIME] - f->epoch;
  for (int j = 0; j < 3; j++) {
    double now = 0.0;
    for (int i = 0; i < 3; i++)
      now += f->real[DCM + 3 * i + j] * body[i];
    if (f->used > 0)
      f->real[V + j] = (now - f->real[R + j]) / dt;
    f->real[R + j] = now;
  }
  f->epoch = f->real[TIME];
  f->used = f->count;
}

int fmi2DoStep(void *c, double t, double h, int set) {
  Filter *f = c;
  (void)t, (void)h, (void)set;
  if (f->count > f->used && f->valid)
    estimate(f);
  return OK;
}

/* The rest is the same for every filter. */

const char *fmi2GetVersion(void) { return "2.0"; }
const char *fmi2GetTypesPlatform(void) { return "default"; }

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const void *host, int visible,
                      int logging) {
  (void)name, (void)type, (void)guid, (void)resources, (void)host, (void)visible, (void)logging;
  return calloc(1, sizeof(Filter));
}
void fmi2FreeInstance(void *c) { free(c); }

int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const *names) {
  (void)c, (void)on, (void)n, (void)names;
  return OK;
}
int fmi2SetupExperiment(void *c, int tolerant, double tolerance, double start, int bounded, double stop) {
  (void)c, (void)tolerant, (void)tolerance, (void)start, (void)bounded, (void)stop;
  return OK;
}
int fmi2EnterInitializationMode(void *c) { return c ? OK : FAILED; }
int fmi2ExitInitializationMode(void *c) { return c ? OK : FAILED; }
int fmi2Terminate(void *c) { return c ? OK : FAILED; }
int fmi2Reset(void *c) {
  memset(c, 0, sizeof(Filter));
  return OK;
}

int fmi2GetReal(void *c, const unsigned *r, size_t n, double *v) {
  for (size_t i = 0; i < n; i++) {
    if (r[i] >= REALS)
      return FAILED;
    v[i] = ((Filter *)c)->real[r[i]];
  }
  return OK;
}
int fmi2SetReal(void *c, const unsigned *r, size_t n, const double *v) {
  for (size_t i = 0; i < n; i++) {
    if (r[i] >= REALS)
      return FAILED;
    ((Filter *)c)->real[r[i]] = v[i];
  }
  return OK;
}
int fmi2GetInteger(void *c, const unsigned *r, size_t n, int *v) {
  for (size_t i = 0; i < n; i++)
    v[i] = ((Filter *)c)->count;
  return r ? OK : FAILED;
}
int fmi2SetInteger(void *c, const unsigned *r, size_t n, const int *v) {
  for (size_t i = 0; i < n; i++)
    ((Filter *)c)->count = v[i];
  return r ? OK : FAILED;
}
int fmi2GetBoolean(void *c, const unsigned *r, size_t n, int *v) {
  for (size_t i = 0; i < n; i++)
    v[i] = ((Filter *)c)->valid;
  return r ? OK : FAILED;
}
int fmi2SetBoolean(void *c, const unsigned *r, size_t n, const int *v) {
  for (size_t i = 0; i < n; i++)
    ((Filter *)c)->valid = v[i];
  return r ? OK : FAILED;
}
/* It has no Strings. */
int fmi2GetString(void *c, const unsigned *r, size_t n, const char **v) {
  (void)c, (void)r, (void)v;
  return n == 0 ? OK : FAILED;
}
int fmi2SetString(void *c, const unsigned *r, size_t n, const char *const *v) {
  (void)c, (void)r, (void)v;
  return n == 0 ? OK : FAILED;
}
