/*
 * The functions of FMI 3.0, model exchange and co-simulation, about the routines in model.c.
 *
 * One phase of contact is in it. Where an event function falls through zero the phase ends, and the simulation with it,
 * unless the same phase follows, as where slip has only turned.
 * In co-simulation the method is that of Dormand and Prince, 5(4), with steps by the tolerance asked for.
 */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model.h"

#if defined _WIN32
#define EXPORT __declspec(dllexport)
#else
#define EXPORT __attribute__((visibility("default")))
#endif

typedef enum { OK, WARNING, DISCARD, ERROR, FATAL } Status;
typedef void *Instance;
typedef uint32_t Reference;
typedef void (*LogMessage)(void *environment, Status status, const char *category, const char *message);
typedef void (*IntermediateUpdate)(void *environment, double time, bool set, bool get, bool finished, bool early,
                                   bool *requested, double *until);

/* The variables in the order of their value references. */
enum {
    TIME = 0,
    STATES = 1,
    RATES = STATES + MODEL_STATES,
    PARAMETERS = RATES + MODEL_STATES,
    INPUTS = PARAMETERS + MODEL_PARAMETERS,
    EVENTS = INPUTS + MODEL_INPUTS,
    OUTPUTS = EVENTS + MODEL_EVENTS,
    END = OUTPUTS + MODEL_OUTPUTS
};

typedef struct {
    double t, tolerance;
    double y[MODEL_STATES + 1], p[MODEL_PARAMETERS + 1], u[MODEL_INPUTS + 1], e[MODEL_GIVEN + 1];
    double size[MODEL_EVENTS + 1]; /* the largest value of each event function so far */
    bool begun, ended;
    bool early; /* may a step end early? */
    void *environment;
    LogMessage log;
} Model;

static void say(const Model *m, Status status, const char *text)
{
    if (m->log) m->log(m->environment, status, "logStatus", text);
}

static void rates(const Model *m, double t, const double *y, double *found)
{
    MODEL_RATES(t, y, m->p, m->u, found);
}

static void events(const Model *m, double t, const double *y, double *found)
{
    MODEL_EVENTS_OF(t, y, m->p, m->u, m->e, found);
}

static void reset(Model *m)
{
    m->t = 0.0;
    m->tolerance = 1e-10;
    m->begun = m->ended = false;
    memcpy(m->y, model_start, sizeof model_start);
    memcpy(m->p, model_parameters, sizeof model_parameters);
    memcpy(m->u, model_inputs, sizeof model_inputs);
    memset(m->e, 0, sizeof m->e);
    memset(m->size, 0, sizeof m->size);
}

static Instance instantiate(const char *token, void *environment, LogMessage log)
{
    Model *m;
    if (!token || strcmp(token, MODEL_TOKEN)) {
        if (log) log(environment, ERROR, "logStatus", "The instantiation token is not that of this model.");
        return NULL;
    }
    m = calloc(1, sizeof *m);
    if (!m) return NULL;
    m->environment = environment;
    m->log = log;
    reset(m);
    return m;
}

/* Return the event function that has fallen to zero, or -1; to a share of its size, where the importer has found it. */
static int fallen(Model *m, double share)
{
    double z[MODEL_EVENTS + 1];
    int found = -1;
    events(m, m->t, m->y, z);
    for (int i = 0; i < MODEL_EVENTS; i++) {
        if (fabs(z[i]) > m->size[i]) m->size[i] = fabs(z[i]);
        if (found < 0 && z[i] < share * m->size[i]) found = i;
    }
    return found;
}

static void end(Model *m, int event)
{
    char text[200];
    snprintf(text, sizeof text, "The phase ends by the event '%s' at t = %.17g s; this model has no other.",
             model_event_names[event], m->t);
    say(m, OK, text);
    m->ended = true;
}

/* Begin the phase anew where it follows its own event; tell whether it does. */
static bool goes_on(Model *m, int event)
{
    double after[MODEL_STATES + 1];
    if (!model_goes_on(event, m->t, m->y, m->p, m->u, after)) return false;
    memcpy(m->y, after, sizeof(double) * MODEL_STATES);
    memset(m->size, 0, sizeof m->size);
    MODEL_BEGIN(m->t, m->y, m->p, m->u, m->e);
    return true;
}

/* One step of Dormand and Prince; the error as a share of what the tolerance allows. */
static double step(const Model *m, double h, double *after)
{
    static const double c[] = {0, 1. / 5, 3. / 10, 4. / 5, 8. / 9, 1, 1};
    static const double a[7][6] = {
        {0},
        {1. / 5},
        {3. / 40, 9. / 40},
        {44. / 45, -56. / 15, 32. / 9},
        {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729},
        {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656},
        {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84}};
    static const double b[] = {71. / 57600, 0, -71. / 16695, 71. / 1920, -17253. / 339200, 22. / 525, -1. / 40};
    double k[7][MODEL_STATES + 1], worst = 0;
    for (int s = 0; s < 7; s++) {
        for (int i = 0; i < MODEL_STATES; i++) {
            double sum = 0;
            for (int j = 0; j < s; j++) sum += a[s][j] * k[j][i];
            after[i] = m->y[i] + h * sum;
        }
        rates(m, m->t + c[s] * h, after, k[s]);
    }
    for (int i = 0; i < MODEL_STATES; i++) {
        double sum = 0, share;
        for (int s = 0; s < 7; s++) sum += b[s] * k[s][i];
        share = fabs(h * sum) / (m->tolerance * (1e-3 + fmax(fabs(m->y[i]), fabs(after[i]))));
        if (!(share <= worst)) worst = share; /* what is not a number is the worst */
    }
    return worst;
}

static bool is_past(const Model *m, double t, const double *y)
{
    double z[MODEL_EVENTS + 1];
    events(m, t, y, z);
    for (int i = 0; i < MODEL_EVENTS; i++)
        if (z[i] < 0) return true;
    return false;
}

/* Go on to a time, or to the event that ends the phase. */
static Status advance(Model *m, double until)
{
    double after[MODEL_STATES + 1], h = until - m->t;
    for (long steps = 0; m->t < until; steps++) {
        double left = until - m->t, worst, low = 0, high;
        int event;
        if (h > left) h = left;
        worst = step(m, h, after);
        if (!(worst <= 1)) {
            h *= worst < 1e10 ? fmax(0.1, 0.9 * pow(worst, -0.2)) : 0.1;
            if (m->t + h == m->t || steps > 10000000) {
                say(m, ERROR, "No step is short enough: is the law singular here?");
                return ERROR;
            }
            continue;
        }
        high = h;
        if (is_past(m, m->t + h, after)) { /* halve the step until the event is at its end */
            for (int i = 0; i < 60; i++) {
                double middle = 0.5 * (low + high);
                step(m, middle, after);
                if (is_past(m, m->t + middle, after)) high = middle;
                else low = middle;
            }
            step(m, high, after);
            memcpy(m->y, after, sizeof(double) * MODEL_STATES);
            m->t += high;
            event = fallen(m, 1e-9);
            if (!goes_on(m, event < 0 ? 0 : event)) {
                end(m, event < 0 ? 0 : event);
                return OK;
            }
            continue;
        }
        memcpy(m->y, after, sizeof(double) * MODEL_STATES);
        m->t = h >= left ? until : m->t + h;
        h *= fmin(5, 0.9 * pow(fmax(worst, 1e-10), -0.2));
    }
    return OK;
}

EXPORT const char *fmi3GetVersion(void) { return "3.0"; }

EXPORT Status fmi3SetDebugLogging(Instance i, bool on, size_t n, const char *const categories[])
{
    (void)i, (void)on, (void)n, (void)categories;
    return OK;
}

EXPORT Instance fmi3InstantiateModelExchange(const char *name, const char *token, const char *resources, bool visible,
                                             bool logging, void *environment, LogMessage log)
{
    (void)name, (void)resources, (void)visible;
    return instantiate(token, environment, logging ? log : NULL);
}

EXPORT Instance fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources, bool visible,
                                            bool logging, bool event_mode, bool early, const Reference required[],
                                            size_t n, void *environment, LogMessage log, IntermediateUpdate update)
{
    Model *m = instantiate(token, environment, logging ? log : NULL);
    (void)name, (void)resources, (void)visible, (void)event_mode, (void)required, (void)n, (void)update;
    if (m) m->early = early;
    return m;
}

EXPORT Instance fmi3InstantiateScheduledExecution(const char *name, const char *token, const char *resources,
                                                  bool visible, bool logging, void *environment, LogMessage log,
                                                  void (*clock)(void *), void (*lock)(void), void (*unlock)(void))
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)clock, (void)lock, (void)unlock;
    if (log) log(environment, ERROR, "logStatus", "Scheduled execution is not supported.");
    return NULL;
}

EXPORT void fmi3FreeInstance(Instance i) { free(i); }

EXPORT Status fmi3EnterInitializationMode(Instance i, bool tolerant, double tolerance, double start, bool stops,
                                          double stop)
{
    Model *m = i;
    (void)stops, (void)stop;
    m->t = start;
    if (tolerant && tolerance > 0) m->tolerance = tolerance;
    return OK;
}

EXPORT Status fmi3ExitInitializationMode(Instance i)
{
    Model *m = i;
    MODEL_BEGIN(m->t, m->y, m->p, m->u, m->e);
    m->begun = true;
    return OK;
}

EXPORT Status fmi3EnterEventMode(Instance i) { (void)i; return OK; }
EXPORT Status fmi3Terminate(Instance i) { (void)i; return OK; }
EXPORT Status fmi3Reset(Instance i) { reset(i); return OK; }

EXPORT Status fmi3GetFloat64(Instance i, const Reference which[], size_t n, double values[], size_t count)
{
    Model *m = i;
    double found[MODEL_STATES + MODEL_EVENTS + MODEL_OUTPUTS + 1];
    (void)count;
    for (size_t j = 0; j < n; j++) {
        Reference r = which[j];
        if (r == TIME) values[j] = m->t;
        else if (r < RATES) values[j] = m->y[r - STATES];
        else if (r < PARAMETERS) rates(m, m->t, m->y, found), values[j] = found[r - RATES];
        else if (r < INPUTS) values[j] = m->p[r - PARAMETERS];
        else if (r < EVENTS) values[j] = m->u[r - INPUTS];
        else if (r < OUTPUTS) events(m, m->t, m->y, found), values[j] = found[r - EVENTS];
        else if (r < END) MODEL_OUTPUTS_OF(m->t, m->y, m->p, m->u, found), values[j] = found[r - OUTPUTS];
        else return ERROR;
    }
    return OK;
}

static Status refuse(const Model *m, Reference r, const char *rule, double value)
{
    char text[300];
    bool known = r >= PARAMETERS && r < INPUTS;
    snprintf(text, sizeof text, "%s %s; got %.17g.", known ? model_parameter_names[r - PARAMETERS] : "A value", rule,
             value);
    say(m, ERROR, text);
    return ERROR;
}

EXPORT Status fmi3SetFloat64(Instance i, const Reference which[], size_t n, const double values[], size_t count)
{
    Model *m = i;
    (void)count;
    for (size_t j = 0; j < n; j++) {
        Reference r = which[j];
        if (!isfinite(values[j])) return refuse(m, r, "must be a finite number", values[j]);
        if (r >= PARAMETERS && r < INPUTS) {
            int sign = model_signs[r - PARAMETERS];
            if (sign == 2 && values[j] <= 0) return refuse(m, r, "must be positive", values[j]);
            if (sign == 1 && values[j] < 0) return refuse(m, r, "must not be negative", values[j]);
        }
        if (r >= STATES && r < RATES) m->y[r - STATES] = values[j];
        else if (r >= PARAMETERS && r < INPUTS) m->p[r - PARAMETERS] = values[j];
        else if (r >= INPUTS && r < EVENTS) m->u[r - INPUTS] = values[j];
        else return ERROR;
    }
    return OK;
}

/* All variables are Float64: of any other type there are none to get or to set. */
#define NONE(type, ctype)                                                                                           \
    EXPORT Status fmi3Get##type(Instance i, const Reference which[], size_t n, ctype values[], size_t count)        \
    {                                                                                                               \
        (void)i, (void)which, (void)values, (void)count;                                                            \
        return n ? ERROR : OK;                                                                                      \
    }                                                                                                               \
    EXPORT Status fmi3Set##type(Instance i, const Reference which[], size_t n, const ctype values[], size_t count)  \
    {                                                                                                               \
        (void)i, (void)which, (void)values, (void)count;                                                            \
        return n ? ERROR : OK;                                                                                      \
    }
NONE(Float32, float)
NONE(Int8, int8_t)
NONE(UInt8, uint8_t)
NONE(Int16, int16_t)
NONE(UInt16, uint16_t)
NONE(Int32, int32_t)
NONE(UInt32, uint32_t)
NONE(Int64, int64_t)
NONE(UInt64, uint64_t)
NONE(Boolean, bool)

/* What this model does not have. */
#define MISSING(name, arguments) \
    EXPORT Status name arguments { return ERROR; }
#if defined __GNUC__
#pragma GCC diagnostic ignored "-Wunused-parameter"
#endif
MISSING(fmi3GetString, (Instance i, const Reference r[], size_t n, const char *v[], size_t c))
MISSING(fmi3SetString, (Instance i, const Reference r[], size_t n, const char *const v[], size_t c))
MISSING(fmi3GetBinary, (Instance i, const Reference r[], size_t n, size_t s[], const uint8_t *v[], size_t c))
MISSING(fmi3SetBinary, (Instance i, const Reference r[], size_t n, const size_t s[], const uint8_t *const v[], size_t c))
MISSING(fmi3GetClock, (Instance i, const Reference r[], size_t n, bool v[]))
MISSING(fmi3SetClock, (Instance i, const Reference r[], size_t n, const bool v[]))
MISSING(fmi3GetNumberOfVariableDependencies, (Instance i, Reference r, size_t *n))
MISSING(fmi3GetVariableDependencies, (Instance i, Reference r, size_t d[], Reference x[], size_t e[], int k[], size_t n))
MISSING(fmi3SerializedFMUStateSize, (Instance i, void *s, size_t *n))
MISSING(fmi3SerializeFMUState, (Instance i, void *s, uint8_t b[], size_t n))
MISSING(fmi3DeserializeFMUState, (Instance i, const uint8_t b[], size_t n, void **s))
MISSING(fmi3GetDirectionalDerivative, (Instance i, const Reference u[], size_t n, const Reference k[], size_t o,
                                       const double s[], size_t p, double v[], size_t q))
MISSING(fmi3GetAdjointDerivative, (Instance i, const Reference u[], size_t n, const Reference k[], size_t o,
                                   const double s[], size_t p, double v[], size_t q))
MISSING(fmi3EnterConfigurationMode, (Instance i))
MISSING(fmi3ExitConfigurationMode, (Instance i))
MISSING(fmi3GetIntervalDecimal, (Instance i, const Reference r[], size_t n, double v[], int q[]))
MISSING(fmi3GetIntervalFraction, (Instance i, const Reference r[], size_t n, uint64_t c[], uint64_t d[], int q[]))
MISSING(fmi3GetShiftDecimal, (Instance i, const Reference r[], size_t n, double v[]))
MISSING(fmi3GetShiftFraction, (Instance i, const Reference r[], size_t n, uint64_t c[], uint64_t d[]))
MISSING(fmi3SetIntervalDecimal, (Instance i, const Reference r[], size_t n, const double v[]))
MISSING(fmi3SetIntervalFraction, (Instance i, const Reference r[], size_t n, const uint64_t c[], const uint64_t d[]))
MISSING(fmi3SetShiftDecimal, (Instance i, const Reference r[], size_t n, const double v[]))
MISSING(fmi3SetShiftFraction, (Instance i, const Reference r[], size_t n, const uint64_t c[], const uint64_t d[]))
MISSING(fmi3GetOutputDerivatives, (Instance i, const Reference r[], size_t n, const int32_t o[], double v[], size_t c))
MISSING(fmi3ActivateModelPartition, (Instance i, Reference r, double t))

EXPORT Status fmi3GetFMUState(Instance i, void **state)
{
    if (!*state) *state = malloc(sizeof(Model));
    if (!*state) return ERROR;
    memcpy(*state, i, sizeof(Model));
    return OK;
}

EXPORT Status fmi3SetFMUState(Instance i, void *state) { memcpy(i, state, sizeof(Model)); return OK; }
EXPORT Status fmi3FreeFMUState(Instance i, void **state) { (void)i, free(*state), *state = NULL; return OK; }
EXPORT Status fmi3EvaluateDiscreteStates(Instance i) { (void)i; return OK; }

EXPORT Status fmi3UpdateDiscreteStates(Instance i, bool *again, bool *terminate, bool *nominals, bool *values,
                                       bool *defined, double *next)
{
    Model *m = i;
    int event = m->begun && !m->ended ? fallen(m, m->size[0] > 0 ? 1e-9 : 0) : -1;
    *values = event >= 0 && goes_on(m, event);
    if (event >= 0 && !*values) end(m, event);
    *again = *nominals = *defined = false;
    *terminate = m->ended;
    (void)next;
    return OK;
}

EXPORT Status fmi3EnterContinuousTimeMode(Instance i) { (void)i; return OK; }

EXPORT Status fmi3CompletedIntegratorStep(Instance i, bool final, bool *event_mode, bool *terminate)
{
    (void)final;
    *event_mode = false;
    *terminate = ((Model *)i)->ended;
    (void)fallen(i, 0);
    return OK;
}

EXPORT Status fmi3SetTime(Instance i, double time) { ((Model *)i)->t = time; return OK; }

EXPORT Status fmi3SetContinuousStates(Instance i, const double states[], size_t n)
{
    memcpy(((Model *)i)->y, states, n * sizeof *states);
    return OK;
}

EXPORT Status fmi3GetContinuousStates(Instance i, double states[], size_t n)
{
    memcpy(states, ((Model *)i)->y, n * sizeof *states);
    return OK;
}

EXPORT Status fmi3GetContinuousStateDerivatives(Instance i, double found[], size_t n)
{
    const Model *m = i;
    (void)n;
    rates(m, m->t, m->y, found);
    return OK;
}

EXPORT Status fmi3GetEventIndicators(Instance i, double found[], size_t n)
{
    const Model *m = i;
    (void)n;
    events(m, m->t, m->y, found);
    return OK;
}

EXPORT Status fmi3GetNominalsOfContinuousStates(Instance i, double nominals[], size_t n)
{
    (void)i;
    for (size_t j = 0; j < n; j++) nominals[j] = 1;
    return OK;
}

EXPORT Status fmi3GetNumberOfEventIndicators(Instance i, size_t *n) { (void)i, *n = MODEL_EVENTS; return OK; }
EXPORT Status fmi3GetNumberOfContinuousStates(Instance i, size_t *n) { (void)i, *n = MODEL_STATES; return OK; }
EXPORT Status fmi3EnterStepMode(Instance i) { (void)i; return OK; }

EXPORT Status fmi3DoStep(Instance i, double point, double size, bool final, bool *event, bool *terminate, bool *early,
                         double *last)
{
    Model *m = i;
    Status status;
    (void)final;
    if (!m->ended) m->t = point;
    (void)fallen(m, 0);
    status = m->ended ? OK : advance(m, point + size);
    *event = false;
    *early = m->early && m->t < point + size;
    *terminate = m->ended;
    *last = m->t;
    return status;
}
