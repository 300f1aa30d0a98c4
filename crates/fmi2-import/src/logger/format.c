/* The logger that FMUs are given. A function with any number of arguments can be defined in C only; it formats the message and
   hands it on as one text. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* What the environment of an instance begins with: where finished messages go. */
typedef void (*Keep)(void *environment, int status, const char *category, const char *message);

/* Longest message, with its NUL. */
#define LIMIT ((size_t)1 << 20)

/* Whether a format would write to memory (%n), which nothing that logs has to do. */
static int writes(const char *format) {
  while ((format = strchr(format, '%')) != NULL) {
    format++;
    format += strspn(format, "-+ #0'123456789.*$hlLqjztI");
    if (*format == 'n')
      return 1;
    if (*format != '\0')
      format++;
  }
  return 0;
}

void fmi2_import_log(void *environment, const char *instance, int status, const char *category, const char *format, ...) {
  char brief[512];
  char *text = brief;
  int length;
  Keep keep;
  va_list arguments;
  (void)instance;
  if (environment == NULL)
    return;
  keep = *(const Keep *)environment;
  if (format == NULL || writes(format)) {
    keep(environment, status, category, format);
    return;
  }
  va_start(arguments, format);
  length = vsnprintf(brief, sizeof brief, format, arguments);
  va_end(arguments);
  if (length >= 0 && (size_t)length >= sizeof brief) {
    size_t size = (size_t)length < LIMIT ? (size_t)length + 1 : LIMIT;
    char *whole = malloc(size);
    /* Without memory the beginning has to do. */
    if (whole != NULL) {
      text = whole;
      va_start(arguments, format);
      length = vsnprintf(whole, size, format, arguments);
      va_end(arguments);
    }
  }
  /* What cannot be formatted, a character that the locale does not have for one, is shown as it came. */
  keep(environment, status, category, length < 0 ? format : text);
  if (text != brief)
    free(text);
}
