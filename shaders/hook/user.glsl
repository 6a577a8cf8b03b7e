// The place of the user's functions: their text stands here where a kernel is compiled with them
// (host/shader/).
