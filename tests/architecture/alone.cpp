// A program that is a library with all its parts and what that library names, and nothing else: it links or it does
// not.
int main() {}
