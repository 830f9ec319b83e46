// Linked into every program of a build with sanitizers: how these behave if their environment says nothing else.
// Whatever they find ends the process, so that a test fails; it is no use to go on.

// The names are the sanitizers'; each asks for its own.
extern "C" {

const char* __tsan_default_options() { return "halt_on_error=1:exitcode=66:suppressions=" LIGHTNET_TSAN_SUPPRESSIONS; }

const char* __asan_default_options() { return "detect_leaks=1:detect_stack_use_after_return=1:exitcode=66"; }

const char* __lsan_default_options() { return "exitcode=66"; }

const char* __ubsan_default_options() { return "halt_on_error=1:print_stacktrace=1:exitcode=66"; }
}
