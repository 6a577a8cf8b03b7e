/* The Vulkan drivers that the program lets the loader open. */
#ifndef APP_DRIVERS_H
#define APP_DRIVERS_H

/* Tells the Vulkan loader, by an environment variable, not to open Mesa's drivers for hardware
   where the system has no graphics hardware that they could find: opening them takes some 10 ms.
   Variables that choose drivers stay as they are. Call it before threads are started and before
   Vulkan. */
void drivers_prepare(void);

#endif
