/* A driver as an FMU: 1 mm/s2 from 100 s to 200 s, and 20 mm/s at once at 150 s. Written without the FMI headers. */
#include <stdlib.h>

const char *fmi2GetVersion(void) { return "2.0"; }
const char *fmi2GetTypesPlatform(void) { return "default"; }
void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const void *host, int visible,
                      int logging) {
  (void)name, (void)type, (void)guid, (void)resources, (void)host, (void)visible, (void)logging;
  return calloc(1, sizeof(double));
}
void fmi2FreeInstance(void *c) { free(c); }
int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const *names) {
  (void)c, (void)on, (void)n, (void)names;
  return 0;
}
int fmi2SetupExperiment(void *c, int tolerant, double tolerance, double start, int bounded, double stop) {
  (void)tolerant, (void)tolerance, (void)bounded, (void)stop;
  *(double *)c = start;
  return 0;
}
int fmi2EnterInitializationMode(void *c) { return (void)c, 0; }
int fmi2ExitInitializationMode(void *c) { return (void)c, 0; }
int fmi2Terminate(void *c) { return (void)c, 0; }
int fmi2Reset(void *c) { return (void)c, 0; }
int fmi2DoStep(void *c, double t, double h, int kept) {
  (void)kept;
  *(double *)c = t + h;
  return 0;
}

/* Accelerations, then changes of velocity. */
int fmi2GetReal(void *c, const unsigned *r, size_t n, double *v) {
  double now = *(double *)c;
  for (size_t i = 0; i < n; i++)
    v[i] = r[i] == 0 && now >= 100 && now < 200 ? 1e-3 : r[i] == 4 ? 0.02 : 0.0;
  return 0;
}
int fmi2GetInteger(void *c, const unsigned *r, size_t n, int *v) {
  (void)r;
  for (size_t i = 0; i < n; i++)
    v[i] = *(double *)c >= 150;
  return 0;
}
int fmi2GetBoolean(void *c, const unsigned *r, size_t n, int *v) { return (void)c, (void)r, (void)n, (void)v, 3; }
int fmi2GetString(void *c, const unsigned *r, size_t n, const char **v) { return (void)c, (void)r, (void)n, (void)v, 3; }
int fmi2SetReal(void *c, const unsigned *r, size_t n, const double *v) { return (void)c, (void)r, (void)n, (void)v, 3; }
int fmi2SetInteger(void *c, const unsigned *r, size_t n, const int *v) { return (void)c, (void)r, (void)n, (void)v, 3; }
int fmi2SetBoolean(void *c, const unsigned *r, size_t n, const int *v) { return (void)c, (void)r, (void)n, (void)v, 3; }
int fmi2SetString(void *c, const unsigned *r, size_t n, const char *const *v) {
  return (void)c, (void)r, (void)n, (void)v, 3;
}
