/* A tank as an FMU: level += inflow * h while open. The parameter `answer` is what fmi2DoStep returns; `trace` names a
   file that gets one line for each call at the end of life. Written without the FMI headers, so that the importer is
   tested against declarations it does not share. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifndef VERSION
#define VERSION "2.0"
#endif
#ifndef TYPES
#define TYPES "default"
#endif

#ifdef FORGETS
/* A function of a library that is not named when this one is linked. */
extern double FORGETS(double);
double (*forgotten)(double) = FORGETS;
#endif

typedef struct {
  void (*logger)(void *, const char *, int, const char *, const char *, ...);
  void *(*allocate)(size_t, size_t);
  void (*release)(void *);
  void (*finished)(void *, int);
  void *environment;
} Callbacks;

typedef struct {
  const Callbacks *host;
  char *name;
  double inflow, level, time;
  int answer, steps, open;
  char trace[512], resources[512];
} Tank;

static void note(Tank *t, const char *line) {
  FILE *f = t->trace[0] ? fopen(t->trace, "a") : NULL;
  if (f) {
    fprintf(f, "%s\n", line);
    fclose(f);
  }
}

static void say(Tank *t, int status, const char *text, int number) {
  t->host->logger(t->host->environment, t->name, status, "tank", text, number);
}

const char *fmi2GetVersion(void) { return VERSION; }
const char *fmi2GetTypesPlatform(void) { return TYPES; }

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources, const Callbacks *host,
                      int visible, int logging) {
  char path[640];
  FILE *f;
  Tank *t;
  if (strcmp(guid, "{tank-1}") || type != 1 || visible) {
    host->logger(host->environment, name, 3, "tank", "refused %s", guid);
    return NULL;
  }
#ifdef REFUSE
  host->logger(host->environment, name, 3, "tank", "no licence\n");
  return NULL;
#endif
  t = host->allocate(1, sizeof *t);
  t->host = host;
  t->open = 1;
  t->name = host->allocate(strlen(name) + 1, 1);
  strcpy(t->name, name);
  snprintf(t->resources, sizeof t->resources, "%s", resources + strlen("file://"));
  snprintf(path, sizeof path, "%s/level.txt", t->resources);
  f = fopen(path, "r");
  if (!f || fscanf(f, "%lf", &t->level) != 1) t->level = -1;
  if (f) fclose(f);
  return t;
}

void fmi2FreeInstance(void *c) {
  Tank *t = c;
  void (*release)(void *) = t->host->release;
  note(t, "free");
  release(t->name);
  release(t);
}

int fmi2SetDebugLogging(void *c, int on, size_t n, const char *const categories[]) {
  if (n) say(c, 0, categories[n - 1], 0);
  return 0;
}
int fmi2SetupExperiment(void *c, int has_tolerance, double tolerance, double start, int has_stop, double stop) {
  ((Tank *)c)->time = start;
  return has_tolerance && tolerance <= 0 ? 3 : has_stop && stop < start ? 3 : 0;
}
int fmi2EnterInitializationMode(void *c) { return 0; }
int fmi2ExitInitializationMode(void *c) { return 0; }
int fmi2Terminate(void *c) {
  note(c, "terminate");
  return 0;
}
#ifndef WITHOUT_RESET
int fmi2Reset(void *c) {
  Tank *t = c;
  t->level = t->steps = t->answer = 0;
  return 0;
}
#endif

int fmi2DoStep(void *c, double time, double h, int never_back) {
  Tank *t = c;
  switch (t->answer) {
  case 0: break;
  case 1: say(t, 1, "nearly full", 0); break;
  default: say(t, t->answer, "answer %d at 100%% load", t->answer); return t->answer;
  }
  if (t->open) t->level += t->inflow * h;
  t->time = time + h;
  t->steps++;
  if (!never_back) note(t, "may go back");
  return t->answer;
}
int fmi2GetRealStatus(void *c, int kind, double *value) {
  *value = ((Tank *)c)->time;
  return kind == 2 ? 0 : 2;
}
int fmi2GetBooleanStatus(void *c, int kind, int *value) {
  *value = 1;
  return kind == 3 ? 0 : 2;
}

int fmi2GetReal(void *c, const unsigned *vr, size_t n, double *v) {
  Tank *t = c;
  for (size_t i = 0; i < n; i++) {
    if (vr[i] > 1) return 3;
    v[i] = vr[i] ? t->level : t->inflow;
  }
  return 0;
}
int fmi2SetReal(void *c, const unsigned *vr, size_t n, const double *v) {
  for (size_t i = 0; i < n; i++) {
    if (vr[i] != 0) return 3;
    ((Tank *)c)->inflow = v[i];
  }
  return 0;
}
int fmi2GetInteger(void *c, const unsigned *vr, size_t n, int *v) {
  Tank *t = c;
  for (size_t i = 0; i < n; i++) v[i] = vr[i] ? t->steps : t->answer;
  return 0;
}
int fmi2SetInteger(void *c, const unsigned *vr, size_t n, const int *v) {
  for (size_t i = 0; i < n; i++) ((Tank *)c)->answer = v[i];
  return 0;
}
int fmi2GetBoolean(void *c, const unsigned *vr, size_t n, int *v) {
  for (size_t i = 0; i < n; i++) v[i] = ((Tank *)c)->open;
  return 0;
}
int fmi2SetBoolean(void *c, const unsigned *vr, size_t n, const int *v) {
  for (size_t i = 0; i < n; i++) ((Tank *)c)->open = v[i];
  return 0;
}
int fmi2GetString(void *c, const unsigned *vr, size_t n, const char **v) {
  for (size_t i = 0; i < n; i++) v[i] = vr[i] ? ((Tank *)c)->resources : ((Tank *)c)->trace;
  return 0;
}
int fmi2SetString(void *c, const unsigned *vr, size_t n, const char *const *v) {
  Tank *t = c;
  for (size_t i = 0; i < n; i++) snprintf(t->trace, sizeof t->trace, "%s", v[i]);
  return 0;
}

int fmi2GetFMUstate(void *c, void **state) {
  *state = malloc(sizeof(double));
  memcpy(*state, &((Tank *)c)->level, sizeof(double));
  return 0;
}
int fmi2SetFMUstate(void *c, void *state) {
  memcpy(&((Tank *)c)->level, state, sizeof(double));
  return 0;
}
int fmi2FreeFMUstate(void *c, void **state) {
  note(c, "free state");
  free(*state);
  *state = NULL;
  return 0;
}
int fmi2SerializedFMUstateSize(void *c, void *state, size_t *size) {
  *size = sizeof(double);
  return 0;
}
int fmi2SerializeFMUstate(void *c, void *state, char *bytes, size_t size) {
  memcpy(bytes, state, size);
  return 0;
}
int fmi2DeSerializeFMUstate(void *c, const char *bytes, size_t size, void **state) {
  if (size != sizeof(double)) return 3;
  *state = malloc(size);
  memcpy(*state, bytes, size);
  return 0;
}
