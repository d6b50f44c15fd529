/* What the parts of api_test share: checks that go on after a failure, and small scenes on the cpu backend. */
#ifndef API_TEST_H
#define API_TEST_H

#include <fontana.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>

extern atomic_int failed_checks;
/* An empty folder of this test's. */
extern const char* test_folder;

#define CHECK(expression)                                                            \
    do {                                                                             \
        if (!(expression)) {                                                         \
            fprintf(stderr, "%s:%d: failed: %s\n", __FILE__, __LINE__, #expression); \
            atomic_fetch_add(&failed_checks, 1);                                     \
        }                                                                            \
    } while (0)

#define OK(call) check_status((call), FONTANA_OK, "", #call, __FILE__, __LINE__)
/* The call fails with `status` and one sentence, of which `part` is a part. */
#define REFUSED(call, status, part) check_status((call), (status), (part), #call, __FILE__, __LINE__)
#define BAD(call, part) REFUSED(call, FONTANA_BAD_INPUT, part)

void check_status(fontana_status status, fontana_status expected, const char* part, const char* call, const char* file,
                  int line);

/* Path of `name` in the test's folder; good until the next call on this thread. */
const char* path_of(const char* name);

void set_number(fontana_simulation* simulation, const char* name, double value);
/* Every choice of fluid.method. */
enum { method_count = 4 };
extern const char* const methods[method_count];
/* A floor, frames of 1/240 s, no particles. */
fontana_simulation* make_scene(int threads);
/* side^3 particles somewhat off a lattice, so that no two are alike. */
void add_block(fontana_simulation* simulation, int side);
/* make_scene with a block, and a jet that runs from the first frame on. */
fontana_simulation* make_fountain(int threads);
/* The same by another method than the default. */
fontana_simulation* make_fountain_by(const char* method, int threads);
void step_frames(fontana_simulation* simulation, int count);

/* Of every attribute of every particle and of the number of frames: equal states have equal hashes. */
uint64_t state_hash(fontana_simulation* simulation);

/* The groups of tests. */
void test_tables(void);
void test_simulation_refusals(void);
void test_scene_refusals(void);
void test_file_refusals(void);
void test_lifecycle(void);
void test_threads(void);
void test_stepping(void);
void test_checkpoints(void);

#endif
