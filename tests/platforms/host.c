/* Runs fmu-truth and fmu-nav coupled by a plan and writes every output at every communication point, bit for bit.
 *
 *     host TRUTH_LIBRARY NAV_LIBRARY PLAN OUT
 *
 * PLAN, by plan.py, names variables by value reference, so that no XML is read here. For each case OUT gets one line: mission,
 * filter, the outputs of all points one after another in hexadecimal, and the status that ended it. C, so that it needs no Rust on the platform it runs on. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
typedef HMODULE Library;
static Library open_library(const char *path) { return LoadLibraryA(path); }
static void *function_of(Library library, const char *name) { return (void *)GetProcAddress(library, name); }
#else
#include <dlfcn.h>
typedef void *Library;
static Library open_library(const char *path) { return dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static void *function_of(Library library, const char *name) { return dlsym(library, name); }
#endif

typedef unsigned int Reference;
typedef int Status;
typedef void (*Logger)(void *, const char *, Status, const char *, const char *, ...);
typedef struct {
    Logger log;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, Status);
    void *environment;
} Callbacks;

typedef struct {
    const char *path;
    char guid[80];
    void *instance;
    void *(*instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int);
    void (*free)(void *);
    Status (*setup)(void *, int, double, double, int, double);
    Status (*enter)(void *);
    Status (*leave)(void *);
    Status (*terminate)(void *);
    Status (*step)(void *, double, double, int);
    Status (*get_real)(void *, const Reference *, size_t, double *);
    Status (*set_real)(void *, const Reference *, size_t, const double *);
    Status (*get_integer)(void *, const Reference *, size_t, int *);
    Status (*set_integer)(void *, const Reference *, size_t, const int *);
    Status (*get_boolean)(void *, const Reference *, size_t, int *);
    Status (*set_boolean)(void *, const Reference *, size_t, const int *);
    Status (*set_string)(void *, const Reference *, size_t, const char *const *);
} Fmu;

#define MOST 4096
enum { TRUTH, NAV };
typedef struct { size_t count; Reference from[MOST], to[MOST]; } Links;
static Links reals, integers, booleans;
static struct { size_t count; Reference of[MOST]; } shown[2];

static void silent(void *e, const char *n, Status s, const char *c, const char *m, ...) {
    (void)e, (void)n, (void)s, (void)c, (void)m;
}

static void die(const char *what, const char *which) {
    fprintf(stderr, "host: %s: %s\n", what, which);
    exit(2);
}

static void load(Fmu *fmu) {
    Library library = open_library(fmu->path);
    if (!library) die("cannot load", fmu->path);
#define FIND(field, name) \
    if (!(*(void **)&fmu->field = function_of(library, name))) die("has no " name, fmu->path)
    FIND(instantiate, "fmi2Instantiate");
    FIND(free, "fmi2FreeInstance");
    FIND(setup, "fmi2SetupExperiment");
    FIND(enter, "fmi2EnterInitializationMode");
    FIND(leave, "fmi2ExitInitializationMode");
    FIND(terminate, "fmi2Terminate");
    FIND(step, "fmi2DoStep");
    FIND(get_real, "fmi2GetReal");
    FIND(set_real, "fmi2SetReal");
    FIND(get_integer, "fmi2GetInteger");
    FIND(set_integer, "fmi2SetInteger");
    FIND(get_boolean, "fmi2GetBoolean");
    FIND(set_boolean, "fmi2SetBoolean");
    FIND(set_string, "fmi2SetString");
}

/* Truth's outputs to the inputs of nav of the same name. */
static Status exchange(Fmu *f) {
    static double r[MOST];
    static int i[MOST];
    Status worst = 0, s;
#define CARRY(links, kind, buffer) \
    s = f[TRUTH].get_##kind(f[TRUTH].instance, links.from, links.count, buffer); \
    if (s > worst) worst = s; \
    s = f[NAV].set_##kind(f[NAV].instance, links.to, links.count, buffer); \
    if (s > worst) worst = s
    CARRY(reals, real, r);
    CARRY(integers, integer, i);
    CARRY(booleans, boolean, i);
    return worst;
}

static void show(FILE *out, Fmu *f) {
    static double values[MOST];
    for (int k = 0; k < 2; k++) {
        memset(values, 0, sizeof values);
        f[k].get_real(f[k].instance, shown[k].of, shown[k].count, values);
        for (size_t n = 0; n < shown[k].count; n++) {
            unsigned long long bits;
            memcpy(&bits, &values[n], 8);
            fprintf(out, "%016llx", bits);
        }
    }
}

/* One world and one filter; the status that ended it, fmi2OK at its end. */
static Status fly(FILE *out, Fmu *f, const char *mission, const Reference *mission_file, Reference filter, int which, double step, int steps) {
    Status s = 0;
    for (int k = 0; k < 2 && s <= 1; k++) {
        s = f[k].setup(f[k].instance, 0, 0, 0, 0, 0);
        if (s <= 1) s = f[k].set_string(f[k].instance, &mission_file[k], 1, &mission);
    }
    if (s <= 1) s = f[NAV].set_integer(f[NAV].instance, &filter, 1, &which);
    for (int k = 0; k < 2 && s <= 1; k++) s = f[k].enter(f[k].instance);
    if (s <= 1) s = exchange(f);
    for (int k = 0; k < 2 && s <= 1; k++) s = f[k].leave(f[k].instance);
    for (int n = 0; n < steps && s <= 1; n++) {
        s = f[TRUTH].step(f[TRUTH].instance, n * step, step, 1);
        if (s <= 1) s = exchange(f);
        if (s <= 1) s = f[NAV].step(f[NAV].instance, n * step, step, 1);
        if (s <= 1) show(out, f);
    }
    if (s <= 1)
        for (int k = 0; k < 2; k++) f[k].terminate(f[k].instance);
    return s;
}

int main(int count, char **arguments) {
    static Callbacks callbacks = {silent, calloc, free, NULL, NULL};
    if (count != 5) die("usage", "host TRUTH_LIBRARY NAV_LIBRARY PLAN OUT");
    Fmu f[2] = {{.path = arguments[1]}, {.path = arguments[2]}};
    load(&f[TRUTH]);
    load(&f[NAV]);
    FILE *plan = fopen(arguments[3], "r");
    FILE *out = fopen(arguments[4], "wb");
    if (!plan || !out) die("cannot open", arguments[plan ? 4 : 3]);
    Reference mission_file[2] = {0, 0}, filter = 0;
    char word[32], resources[1024] = "", mission[64], name[64];
    while (fscanf(plan, "%31s", word) == 1) {
        unsigned a, b;
        int which, steps;
        double step;
        if (!strcmp(word, "guid") && fscanf(plan, "%u %63s", &a, name) == 2) {
            strcpy(f[a].guid, name);
        } else if (!strcmp(word, "resources") && fscanf(plan, "%1023s", resources) == 1) {
        } else if (!strcmp(word, "mission_file") && fscanf(plan, "%u %u", &a, &b) == 2) {
            mission_file[a] = b;
        } else if (!strcmp(word, "filter") && fscanf(plan, "%u", &filter) == 1) {
        } else if (!strcmp(word, "shown") && fscanf(plan, "%u %u", &a, &b) == 2 && shown[a].count < MOST) {
            shown[a].of[shown[a].count++] = b;
        } else if ((!strcmp(word, "Real") || !strcmp(word, "Integer") || !strcmp(word, "Boolean")) && fscanf(plan, "%u %u", &a, &b) == 2) {
            Links *links = *word == 'R' ? &reals : *word == 'I' ? &integers : &booleans;
            if (links->count == MOST) die("too many links", word);
            links->from[links->count] = a;
            links->to[links->count++] = b;
        } else if (!strcmp(word, "case") && fscanf(plan, "%63s %63s %d %lf %d", mission, name, &which, &step, &steps) == 5) {
            for (int k = 0; k < 2; k++) {
                f[k].instance = f[k].instantiate("host", 1, f[k].guid, resources, &callbacks, 0, 0);
                if (!f[k].instance) die("does not instantiate", f[k].path);
            }
            fprintf(out, "%s %s ", mission, name);
            Status s = fly(out, f, mission, mission_file, filter, which, step, steps);
            fprintf(out, " %d\n", s);
            for (int k = 0; k < 2; k++) f[k].free(f[k].instance);
        } else {
            die("cannot read the plan at", word);
        }
    }
    return fclose(out) ? 2 : 0;
}
