// How programs keep their memory: jemalloc reads this before main() begins.
// DECISIONS: memory-in-large-pages

extern "C" {
extern const char* malloc_conf;
const char* malloc_conf = "thp:always,background_thread:true";
}
