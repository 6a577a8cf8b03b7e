/* Preloaded by sanitized tests: drivers stay loaded, so that leaks in them can be told by name
   (lsan.supp) from leaks of whit. */
int dlclose(void *handle);

int dlclose(void *handle)
{
    (void)handle;
    return 0;
}
