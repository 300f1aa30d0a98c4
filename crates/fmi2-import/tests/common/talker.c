/* A tank whose steps log what foreign FMUs log; `answer` chooses the message. */
#define fmi2DoStep tank_step
#include "tank.c"
#undef fmi2DoStep

int fmi2DoStep(void *c, double time, double h, int never_back) {
  Tank *t = c;
  void *host = t->host->environment;
  void (*log)(void *, const char *, int, const char *, const char *, ...) = t->host->logger;
  (void)h, (void)never_back;
  switch (t->answer) {
  case 10: log(host, t->name, 1, "talk", "%s is beyond %d m, by %.2f at %5.1e", "range", 17, 0.125, 12345.678); break;
  case 11: log(host, t->name, 0, "talk", NULL); break;
  case 12: log(host, t->name, 0, NULL, "no category"); break;
  case 13: log(host, t->name, 0, "talk", "Beh\xe4lter %d", 3); break;
  case 14: log(host, t->name, 0, "talk", "50%% of it\n"); break;
  case 15: log(host, t->name, 1, "talk", "#r1# exceeds #r%d#, item ##%d", 0, 4); break;
  case 16: log(host, t->name, 0, "talk", "%0*d|%c", 3000, 7, 'x'); break;
  case 17: {
    int written = 5;
    log(host, t->name, 0, "talk", "writes %n", &written);
    t->steps = written;
    break;
  }
  case 18: log(host, t->name, 1, "talk", "level %g m is low at %g s", t->level, time); break;
  case 19: log(NULL, t->name, 1, "talk", "to nobody %d", 1); break;
  case 20: log(host, NULL, 77, "talk", ""); break;
  case 21: log(host, t->name, 0, "talk", "%s %ld %llu %p", (char *)"long", 1L << 40, ~0ULL, NULL); break;
  }
  return 0;
}
