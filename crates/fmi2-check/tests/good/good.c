/* A small tank that keeps to FMI 2.0 in everything, and a switch for each way in which an FMU may not. Written without the FMI
   headers. x' = u2 - x while enabled; y = gain u1 + x; z = x. */
#include <fenv.h>
#include <locale.h>
#include <math.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#ifdef SETS_SIGNAL
/* Of its own: in a shell's background the signal is ignored from the beginning. */
static void deaf(int signal) { (void)signal; }
#endif

enum { OK, WARNING, DISCARD, ERROR, FATAL };
enum { MADE = 1, SETTING = 2, RUNNING = 4, ENDED = 8 };
enum { TIME, GAIN, LIMIT, DOUBLE_GAIN, PI, U1, U2, X, DER_X, Y, Z, REALS };
enum { COUNT0, MODE, K, N, PHASE, INTEGERS };

typedef void (*Logger)(void *, const char *, int, const char *, const char *, ...);
typedef struct {
  Logger logger;
  void *(*allocate)(size_t, size_t);
  void (*release)(void *);
  void (*finished)(void *, int);
  void *environment;
} Callbacks;

/* What a saved state holds. */
typedef struct {
  int phase, set_up, steps;
  double now, gain, limit, u1, u2, x;
  int count0, mode, k, enabled;
  char label[64];
} Values;

typedef struct {
  Values v;
  const Callbacks *host;
  const char *name;
  int logging;
} Tank;

/* Shared by all instances, which only defects make use of. */
static int shared;

static void say(Tank *t, int status, const char *category, const char *text) {
#ifdef LOGGER_UNCHECKED
  t->host->logger(t->host->environment, t->name, status, category, "%s", text);
#else
  if (t->host && t->host->logger)
    t->host->logger(t->host->environment, t->name, status, category, "%s", text);
#endif
}

static int refuse(Tank *t, const char *text) {
  say(t, ERROR, "logStatusError", text);
  return ERROR;
}

static int out_of_order(Tank *t, int allowed) {
#ifdef ANY_ORDER
  (void)t, (void)allowed;
  return 0;
#else
  return !(t->v.phase & allowed);
#endif
}

static void start(Tank *t) {
  memset(&t->v, 0, sizeof t->v);
  t->v.phase = MADE;
#ifdef START_OFF
  t->v.gain = 3;
#else
  t->v.gain = 2;
#endif
  t->v.limit = 100, t->v.x = 1, t->v.count0 = 3, t->v.mode = 1, t->v.enabled = 1;
  strcpy(t->v.label, "tank");
}

#ifndef NO_VERSION
const char *fmi2GetVersion(void) {
#ifdef VERSION_OFF
  return "2.1";
#else
  return "2.0";
#endif
}
#endif
const char *fmi2GetTypesPlatform(void) {
#ifdef PLATFORM_OFF
  return "x86_64";
#else
  return "default";
#endif
}

#ifdef UNRESOLVED
extern double nobody_has_this(double);
#endif

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const Callbacks *host, int visible,
                      int logging) {
  (void)type, (void)resources, (void)visible;
#ifdef UNRESOLVED
  if (nobody_has_this(1) > 2)
    return NULL;
#endif
#ifdef INSTANTIATE_NULL
  host->logger(host->environment, name, ERROR, "logStatusError", "no room for a tank");
  return NULL;
#endif
#ifdef ONLY_ONE
  if (shared)
    return NULL;
  shared = 1;
#endif
#ifdef SHARES_FRESH
  shared = 0;
#endif
#ifndef ANY_GUID
  if (strcmp(guid, "{6f0f1d0c-8f5b-4d9e-9a51-0c2f3f1d7a10}"))
    return NULL;
#else
  (void)guid;
#endif
#ifdef HOST_MEMORY
  Tank *t = host->allocate(1, sizeof *t);
#else
  Tank *t = calloc(1, sizeof *t);
#endif
  t->host = host, t->name = name, t->logging = logging;
  start(t);
#ifdef MOVES_FOLDER
  if (chdir("/"))
    return NULL;
#endif
#ifdef SETS_LOCALE
  setenv("LC_ALL", "C.UTF-8", 1);
  setlocale(LC_ALL, "");
#endif
#ifdef SETS_SIGNAL
  signal(SIGINT, deaf);
#endif
#ifdef CHATTY
  say(t, OK, "logAll", "made");
#else
  if (logging)
#ifdef CATEGORY_OFF
    say(t, OK, "gossip", "made");
#else
    say(t, OK, "logAll", "made");
#endif
#endif
  return t;
}

void fmi2FreeInstance(void *c) {
#ifdef FREE_NULL_CRASHES
  *(volatile int *)c = 0;
#endif
  if (!c)
    return;
#ifdef ONLY_ONE
  shared = 0;
#endif
  free(c);
}

int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const *names) {
  (void)n, (void)names;
  ((Tank *)c)->logging = on;
#ifdef LOGGING_REFUSED
  return ERROR;
#endif
  return OK;
}

int fmi2SetupExperiment(void *c, int tolerant, double tolerance, double start_time, int bounded, double stop) {
  Tank *t = c;
  (void)tolerant, (void)tolerance, (void)bounded, (void)stop;
  if (out_of_order(t, MADE))
    return refuse(t, "the experiment is set up before initialization");
  t->v.set_up = 1, t->v.now = start_time;
  return OK;
}

int fmi2EnterInitializationMode(void *c) {
  Tank *t = c;
#ifdef INIT_ERROR
  return refuse(t, "no water");
#endif
#ifdef ABORTS
  abort();
#endif
  if (out_of_order(t, MADE) || !t->v.set_up)
    return refuse(t, "initialization begins once, after the experiment is set up");
  t->v.phase = SETTING;
  return OK;
}

int fmi2ExitInitializationMode(void *c) {
  Tank *t = c;
  if (out_of_order(t, SETTING))
    return refuse(t, "initialization has not begun");
  t->v.phase = RUNNING;
  return OK;
}

int fmi2Terminate(void *c) {
  Tank *t = c;
#ifdef TERMINATE_ERROR
  return ERROR;
#endif
  if (out_of_order(t, RUNNING))
    return refuse(t, "there is nothing to terminate");
  t->v.phase = ENDED;
  return OK;
}

int fmi2Reset(void *c) {
#ifdef RESET_FORGETS
  double x = ((Tank *)c)->v.x;
  start(c);
  ((Tank *)c)->v.x = x;
#elif defined RESET_KEEPS_INPUT
  double u1 = ((Tank *)c)->v.u1;
  start(c);
  ((Tank *)c)->v.u1 = u1;
#elif defined RESET_ERROR
  (void)c;
  return ERROR;
#else
  start(c);
#endif
  return OK;
}

static double slope(const Tank *t) { return t->v.enabled ? t->v.u2 - t->v.x : 0; }

int fmi2DoStep(void *c, double at, double h, int keep) {
  Tank *t = c;
  (void)keep;
#ifdef CRASHES
  if (t->v.steps == 2)
    *(volatile int *)NULL = 1;
#endif
#ifdef EXITS
  if (t->v.steps == 2)
    exit(0);
#endif
#ifdef HANGS
  volatile int forever = t->v.steps == 2;
  while (forever) {
  }
#endif
#ifdef NAN_STEP_HANGS
  volatile int endless = isnan(h);
  while (endless) {
  }
#endif
  if (out_of_order(t, RUNNING))
    return refuse(t, "there is no step now");
#ifndef ANY_STEP
  if (!(h > 0 && fabs(at - t->v.now) < 1e-9))
    return refuse(t, "a step begins where the last one ended, and goes forward");
#endif
#ifdef DISCARDS
  return DISCARD;
#endif
#ifdef STATUS_OFF
  return 9;
#endif
#ifdef ROUNDS_DOWN
  fesetround(FE_DOWNWARD);
#endif
#ifdef PRINTS
  printf("a step\n");
  fflush(stdout);
#endif
  t->v.x += h * slope(t);
  t->v.now = at + h;
  t->v.steps++;
#if defined REMEMBERS || defined SHARES_FRESH
  shared++;
#endif
  return OK;
}

static int read_real(Tank *t, unsigned r, double *v) {
  switch (r) {
  case TIME: *v = t->v.now; break;
  case GAIN: *v = t->v.gain; break;
  case LIMIT: *v = t->v.limit; break;
  case DOUBLE_GAIN: *v = 2 * t->v.gain; break;
  case PI: *v = 3.141592653589793; break;
  case U1: *v = t->v.u1; break;
  case U2: *v = t->v.u2; break;
  case X: *v = t->v.x; break;
  case DER_X: *v = slope(t); break;
  case Y:
    *v = t->v.gain * t->v.u1 + t->v.x;
#ifdef NOT_FINITE
    *v = NAN;
#endif
#ifdef OUT_OF_RANGE
    *v = 2000;
#endif
    break;
  case Z:
    *v = t->v.x;
#ifdef HIDDEN_INPUT
    if (t->v.phase == RUNNING)
      *v += t->v.u2;
#endif
#ifdef HIDDEN_KNOWN
    if (t->v.phase == SETTING)
      *v += t->v.gain;
#endif
    break;
  default: return 0;
  }
  return 1;
}

int fmi2GetReal(void *c, const unsigned *r, size_t n, double *v) {
  for (size_t i = 0; i < n; i++) {
#ifdef TABLE_UNCHECKED
    if (r[i] >= REALS)
      *(volatile int *)NULL = 1;
#endif
    if (!read_real(c, r[i], &v[i])) {
#ifdef ANY_REFERENCE
      v[i] = 0;
#else
      return refuse(c, "no such Real");
#endif
    }
  }
#ifdef GET_ERROR
  return ERROR;
#endif
  return OK;
}

int fmi2SetReal(void *c, const unsigned *r, size_t n, const double *v) {
  Tank *t = c;
  for (size_t i = 0; i < n; i++) {
#ifndef ANY_NUMBER
    if (!isfinite(v[i]))
      return refuse(t, "no number");
#endif
    switch (r[i]) {
    case GAIN:
#ifndef FIXED_SETTABLE
      if (out_of_order(t, MADE | SETTING))
        return refuse(t, "fixed");
#endif
      t->v.gain = v[i];
      break;
    case LIMIT: t->v.limit = v[i]; break;
    case U1: t->v.u1 = v[i]; break;
    case U2: t->v.u2 = v[i]; break;
    case X:
      if (out_of_order(t, MADE | SETTING))
        return refuse(t, "a state");
      t->v.x = v[i];
      break;
#ifdef CONSTANT_SETTABLE
    case PI: break;
#endif
#ifdef OUTPUT_SETTABLE
    case Y: break;
#endif
#ifdef ANY_REFERENCE
    default: break;
#else
    default: return refuse(t, "no such Real that can be set");
#endif
    }
  }
  return OK;
}

int fmi2GetInteger(void *c, const unsigned *r, size_t n, int *v) {
  Tank *t = c;
  for (size_t i = 0; i < n; i++)
    switch (r[i]) {
    case COUNT0: v[i] = t->v.count0; break;
    case MODE: v[i] = t->v.mode; break;
    case K: v[i] = t->v.k; break;
    case N:
      v[i] = t->v.count0 + t->v.k + t->v.steps;
#ifdef REMEMBERS
      v[i] += shared;
#endif
#ifdef SHARES_FRESH
      v[i] = t->v.count0 + t->v.k + shared;
#endif
      break;
    case PHASE:
      v[i] = t->v.x > 50 ? 2 : 1;
#ifdef NO_ITEM
      v[i] = 7;
#endif
      break;
    default: return refuse(t, "no such Integer");
    }
  return OK;
}

int fmi2SetInteger(void *c, const unsigned *r, size_t n, const int *v) {
  Tank *t = c;
  for (size_t i = 0; i < n; i++)
    switch (r[i]) {
    case K: t->v.k = v[i]; break;
    case COUNT0:
    case MODE:
      if (out_of_order(t, MADE | SETTING))
        return refuse(t, "fixed");
      *(r[i] == MODE ? &t->v.mode : &t->v.count0) = v[i];
      break;
    default: return refuse(t, "no such Integer that can be set");
    }
  return OK;
}

int fmi2GetBoolean(void *c, const unsigned *r, size_t n, int *v) {
  Tank *t = c;
  for (size_t i = 0; i < n; i++) {
    if (r[i] > 1)
      return refuse(t, "no such Boolean");
    v[i] = r[i] == 0 ? t->v.enabled : t->v.x >= t->v.limit;
#ifdef BOOLEAN_OFF
    if (r[i] == 1)
      v[i] = 7;
#endif
  }
  return OK;
}

int fmi2SetBoolean(void *c, const unsigned *r, size_t n, const int *v) {
  Tank *t = c;
  for (size_t i = 0; i < n; i++) {
    if (r[i] != 0 || out_of_order(t, MADE | SETTING))
      return refuse(t, "no such Boolean that can be set");
    t->v.enabled = v[i] != 0;
  }
  return OK;
}

int fmi2GetString(void *c, const unsigned *r, size_t n, const char **v) {
  Tank *t = c;
  for (size_t i = 0; i < n; i++) {
    if (r[i] > 1)
      return refuse(t, "no such String");
    v[i] = t->v.label;
#ifdef STRING_NULL
    if (r[i] == 1)
      v[i] = NULL;
#endif
  }
  return OK;
}

int fmi2SetString(void *c, const unsigned *r, size_t n, const char *const *v) {
  Tank *t = c;
  for (size_t i = 0; i < n; i++) {
    if (r[i] != 0 || out_of_order(t, MADE | SETTING) || strlen(v[i]) >= sizeof t->v.label)
      return refuse(t, "no such String that can be set");
    strcpy(t->v.label, v[i]);
  }
  return OK;
}

int fmi2GetFMUstate(void *c, void **state) {
  if (!*state)
    *state = calloc(1, sizeof(Values));
  memcpy(*state, &((Tank *)c)->v, sizeof(Values));
  return OK;
}
int fmi2SetFMUstate(void *c, void *state) {
#ifdef STATE_ERROR
  return ERROR;
#endif
#ifdef STATE_FORGETS
  int steps = ((Tank *)c)->v.steps;
#endif
  memcpy(&((Tank *)c)->v, state, sizeof(Values));
#ifdef STATE_FORGETS
  ((Tank *)c)->v.steps = steps;
#endif
  return OK;
}
int fmi2FreeFMUstate(void *c, void **state) {
  (void)c;
  free(*state);
#ifndef STATE_STAYS
  *state = NULL;
#endif
  return OK;
}
int fmi2SerializedFMUstateSize(void *c, void *state, size_t *size) {
  (void)c, (void)state;
  *size = sizeof(Values);
  return OK;
}
int fmi2SerializeFMUstate(void *c, void *state, char *bytes, size_t size) {
  (void)c;
  if (size != sizeof(Values))
    return ERROR;
  memcpy(bytes, state, size);
#ifdef SERIALIZES_POINTER
  ((Values *)bytes)->x = 0;
#endif
  return OK;
}
int fmi2DeSerializeFMUstate(void *c, const char *bytes, size_t size, void **state) {
  (void)c;
#ifdef DESERIALIZE_ERROR
  return ERROR;
#endif
  if (size != sizeof(Values))
    return ERROR;
  *state = malloc(size);
  memcpy(*state, bytes, size);
  return OK;
}

/* Not offered. */
#ifndef NO_DIRECTIONAL
int fmi2GetDirectionalDerivative(void) { return ERROR; }
#endif
int fmi2SetRealInputDerivatives(void) { return ERROR; }
int fmi2GetRealOutputDerivatives(void) { return ERROR; }
int fmi2CancelStep(void) { return ERROR; }
#ifndef NO_GET_STATUS
int fmi2GetStatus(void) { return DISCARD; }
#endif
int fmi2GetRealStatus(void) { return DISCARD; }
int fmi2GetIntegerStatus(void) { return DISCARD; }
int fmi2GetBooleanStatus(void) { return DISCARD; }
int fmi2GetStringStatus(void) { return DISCARD; }
