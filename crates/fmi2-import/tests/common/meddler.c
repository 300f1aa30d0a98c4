/* A tank that changes everything a library can change for its process, at the place the macro names, and goes on as a tank. */
#define _GNU_SOURCE
#define fmi2Instantiate tank_instantiate
#define fmi2FreeInstance tank_free
#define fmi2ExitInitializationMode tank_exit
#define fmi2DoStep tank_step
#define fmi2GetReal tank_get_real
#include "tank.c"
#undef fmi2Instantiate
#undef fmi2FreeInstance
#undef fmi2ExitInitializationMode
#undef fmi2DoStep
#undef fmi2GetReal

#include <fenv.h>
#include <locale.h>
#include <signal.h>
#include <unistd.h>
#ifdef __x86_64__
#include <immintrin.h>
#endif

#ifndef LOCALE
#define LOCALE "C.UTF-8"
#endif

static void handler(int signal) { (void)signal; }

static void meddle(void) {
  static const int signals[] = {SIGINT, SIGTERM, SIGSEGV, SIGFPE, SIGUSR2, SIGCHLD};
  sigset_t blocked;
  fesetround(FE_DOWNWARD);
#ifdef __x86_64__
  unsigned short word = 0x0c00; /* x87: single precision, towards zero, all exceptions unmasked */
  _mm_setcsr(_mm_getcsr() | 0x8040); /* flush to zero, denormals are zero */
#endif
  feraiseexcept(FE_INEXACT);
  feenableexcept(FE_DIVBYZERO);
#ifdef __x86_64__
  __asm__ volatile("fldcw %0" : : "m"(word));
#endif
  if (chdir("/") || !setlocale(LC_ALL, LOCALE)) abort();
  uselocale(newlocale(LC_ALL_MASK, "C.UTF-8", NULL));
  for (size_t i = 0; i < sizeof signals / sizeof *signals; i++) signal(signals[i], handler);
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGUSR1);
  pthread_sigmask(SIG_BLOCK, &blocked, NULL);
}

#ifdef AT_LOAD
__attribute__((constructor)) static void loaded(void) { meddle(); }
__attribute__((destructor)) static void unloaded(void) { meddle(); }
#endif

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const Callbacks *host,
                      int visible, int logging) {
  void *c = tank_instantiate(name, type, guid, resources, host, visible, logging);
#ifdef AT_LIFE
  meddle();
#endif
  return c;
}
int fmi2ExitInitializationMode(void *c) {
#ifdef AT_LIFE
  meddle();
#endif
  return tank_exit(c);
}
void fmi2FreeInstance(void *c) {
#ifdef AT_LIFE
  meddle();
#endif
  tank_free(c);
}
int fmi2DoStep(void *c, double time, double h, int never_back) {
#ifdef AT_STEP
  if (((Tank *)c)->steps >= AT_STEP) meddle();
#endif
  return tank_step(c, time, h, never_back);
}
int fmi2GetReal(void *c, const unsigned *vr, size_t n, double *v) {
#ifdef AT_GET
  meddle();
#endif
  return tank_get_real(c, vr, n, v);
}
