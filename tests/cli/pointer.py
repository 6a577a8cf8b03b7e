"""Moves the pointer of the X server about in the window at the upper left, until its parent ends: what a hand on the mouse
does while a replay runs."""
import ctypes
import os
import sys
import time

try:
    x = ctypes.CDLL("libX11.so.6")
except OSError:
    sys.exit(77)
x.XOpenDisplay.restype = ctypes.c_void_p
x.XDefaultRootWindow.argtypes = [ctypes.c_void_p]
x.XDefaultRootWindow.restype = ctypes.c_ulong
x.XWarpPointer.argtypes = [ctypes.c_void_p, ctypes.c_ulong, ctypes.c_ulong] + 6 * [ctypes.c_int]
x.XFlush.argtypes = [ctypes.c_void_p]
display = x.XOpenDisplay(None)
root = x.XDefaultRootWindow(display)
parent, at = os.getppid(), 0
while os.getppid() == parent:
    at += 1
    x.XWarpPointer(display, 0, root, 0, 0, 0, 0, at % 300, 100 + at % 50)
    x.XFlush(display)
    time.sleep(0.002)
