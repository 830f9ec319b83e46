// Memory of programs: jemalloc reads this before main() begins. One thread of its own is enough, and takes
// none from those whose number is limited when it is least expected.
// DECISIONS: memory-in-large-pages
#include <unistd.h>

#include <cstring>

extern "C" {
extern const char* malloc_conf;
const char* malloc_conf = "thp:always,background_thread:true,max_background_threads:1";

// Where no thread is to be had it does without its own, and that is nothing to tell a user, who asked for a picture.
static void say_of_memory(void*, const char* text) {
    if (std::strstr(text, "background thread creation failed")) return;
    if (::write(STDERR_FILENO, text, std::strlen(text)) < 0) return;  // nobody listens
}
extern void (*malloc_message)(void* opaque, const char* text);
void (*malloc_message)(void* opaque, const char* text) = say_of_memory;
}
