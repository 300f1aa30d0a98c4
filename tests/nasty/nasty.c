/* A filter that misbehaves on purpose, as an FMU. It estimates zeros at every sample and offers to push the chaser at 1 m/s2, which
   nobody has asked it to; the parameter `deed` says what it does to
   the process that has loaded it, and in which call. Written without the FMI headers. */
#define _GNU_SOURCE
#include <fenv.h>
#include <locale.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum Deed {
  NONE,
  SEGFAULT,
  ABORT,
  EXIT,
  LOOP_IN_STEP,
  LOOP_IN_INIT,
  EAT_MEMORY,
  NOT_A_NUMBER,
  STATUS_77,
  PRINT,
  SEGFAULT_IN_INIT,
  WARN,
  ERR,
  FATAL,
  DISCARD,
  SET_FLOATING_POINT_MODE,
  CHANGE_FOLDER,
  SET_LOCALE,
  TAKE_SIGNALS,
  CLOSE_FILES,
  EXIT_WITHOUT_HANDLERS,
  RUN_OUT_OF_STACK,
};

typedef void (*Logger)(void *environment, const char *name, int status, const char *category, const char *message, ...);
/* The first and the last of the host's functions. */
typedef struct {
  Logger log;
  void *others[3];
  void *environment;
} Host;

typedef struct {
  int deed, count, steps;
  double time, now;
  const Host *host;
} Filter;

static void loop(void) {
  volatile int forever = 1;
  while (forever) {
  }
}

static void crash(void) {
  int *volatile nowhere = NULL;
  *nowhere = 1;
}

const char *fmi2GetVersion(void) { return "2.0"; }
const char *fmi2GetTypesPlatform(void) { return "default"; }
void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const void *host, int visible,
                      int logging) {
  (void)name, (void)type, (void)guid, (void)resources, (void)visible, (void)logging;
  Filter *f = calloc(1, sizeof *f);
  if (f)
    f->host = host;
  return f;
}
void fmi2FreeInstance(void *c) { free(c); }
int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const *names) {
  (void)c, (void)on, (void)n, (void)names;
  return 0;
}
int fmi2SetupExperiment(void *c, int tolerant, double tolerance, double start, int bounded, double stop) {
  (void)c, (void)tolerant, (void)tolerance, (void)start, (void)bounded, (void)stop;
  return 0;
}
int fmi2EnterInitializationMode(void *c) {
  int deed = ((Filter *)c)->deed;
  if (deed == LOOP_IN_INIT)
    loop();
  if (deed == SEGFAULT_IN_INIT)
    crash();
  return 0;
}
int fmi2ExitInitializationMode(void *c) {
  (void)c;
  return 0;
}
int fmi2Terminate(void *c) {
  (void)c;
  return 0;
}
int fmi2Reset(void *c) {
  (void)c;
  return 0;
}

static void tell(const Filter *f, int status, const char *text) {
  f->host->log(f->host->environment, "nasty", status, "logAll", "%s at step %d", text, f->steps);
}

static int deeper(int depth) {
  volatile char eaten[4096];
  eaten[0] = (char)depth;
  return depth < 0 ? 0 : deeper(depth + 1) + eaten[0];
}

/* From the hundredth step of a run on, so that there is something to lose. */
int fmi2DoStep(void *c, double t, double h, int set) {
  Filter *f = c;
  (void)set;
  f->now = t + h;
  if (++f->steps < 100)
    return 0;
  switch (f->deed) {
  case SEGFAULT:
    fprintf(stderr, "about to touch what is not mine\n");
    crash();
    break;
  case ABORT:
    abort();
  case EXIT:
    exit(0);
  case LOOP_IN_STEP:
    loop();
    break;
  case EAT_MEMORY:
    for (size_t eaten = 0; eaten < ((size_t)2 << 30); eaten += (size_t)64 << 20) {
      char *more = malloc((size_t)64 << 20);
      if (!more)
        abort();
      memset(more, 1, (size_t)64 << 20);
    }
    break;
  case PRINT:
    printf("scenario,filter,nonsense\n%s\n", "\xff\xfe not for the table");
    fflush(stdout);
    break;
  case WARN:
    f->host->log(f->host->environment, "nasty", 1, "logAll", "lacks %s", "conviction");
    break;
  case ERR:
    tell(f, 3, "gave up");
    return 3;
  case FATAL:
    tell(f, 4, "beyond repair");
    return 4;
  case DISCARD:
    return 2;
  case SET_FLOATING_POINT_MODE:
    fesetround(FE_UPWARD);
    feenableexcept(FE_INEXACT);
    break;
  case CHANGE_FOLDER:
    if (chdir("/") != 0)
      return 3;
    umask(0777);
    break;
  case SET_LOCALE:
    setlocale(LC_ALL, "");
    setlocale(LC_NUMERIC, "de_DE.UTF-8");
    break;
  case TAKE_SIGNALS:
    signal(SIGTERM, SIG_IGN);
    signal(SIGINT, SIG_IGN);
    signal(SIGPIPE, SIG_DFL);
    break;
  case CLOSE_FILES:
    for (int file = 0; file < 1024; file++)
      close(file);
    break;
  case EXIT_WITHOUT_HANDLERS:
    _exit(0);
  case RUN_OUT_OF_STACK:
    return deeper(1) == 7;
  }
  return 0;
}

int fmi2GetReal(void *c, const unsigned *r, size_t n, double *v) {
  Filter *f = c;
  for (size_t i = 0; i < n; i++)
    v[i] = r[i] == 0 ? f->time : r[i] > 6 ? 1.0 : f->deed == NOT_A_NUMBER && f->steps >= 100 ? NAN : 0.0;
  return 0;
}
int fmi2SetReal(void *c, const unsigned *r, size_t n, const double *v) {
  for (size_t i = 0; i < n; i++)
    if (r[i] == 0)
      ((Filter *)c)->time = v[i];
  return 0;
}
int fmi2GetInteger(void *c, const unsigned *r, size_t n, int *v) {
  Filter *f = c;
  for (size_t i = 0; i < n; i++)
    v[i] = r[i] == 0 ? f->deed : r[i] == 1 ? f->count : f->deed == STATUS_77 ? 77 : 2;
  return 0;
}
int fmi2SetInteger(void *c, const unsigned *r, size_t n, const int *v) {
  Filter *f = c;
  for (size_t i = 0; i < n; i++)
    *(r[i] == 0 ? &f->deed : &f->count) = v[i];
  return 0;
}
int fmi2GetBoolean(void *c, const unsigned *r, size_t n, int *v) {
  (void)c, (void)r;
  memset(v, 0, n * sizeof *v);
  return 0;
}
int fmi2SetBoolean(void *c, const unsigned *r, size_t n, const int *v) {
  (void)c, (void)r, (void)n, (void)v;
  return 0;
}
int fmi2GetString(void *c, const unsigned *r, size_t n, const char **v) {
  (void)c, (void)r;
  for (size_t i = 0; i < n; i++)
    v[i] = "";
  return 0;
}
int fmi2SetString(void *c, const unsigned *r, size_t n, const char *const *v) {
  (void)c, (void)r, (void)n, (void)v;
  return 0;
}
