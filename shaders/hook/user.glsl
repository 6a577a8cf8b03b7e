// Replaced by the text of the user's file where a kernel is compiled with it (host/shader/).
