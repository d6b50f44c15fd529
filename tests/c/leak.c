/* Leaks on purpose: shows whether LeakSanitizer works where the tests are built. */
#include <stdlib.h>

int main(void) {
    char* volatile memory = malloc(10);
    memory = NULL;
    return memory != NULL;
}
