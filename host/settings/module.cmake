# What settings are called, over libwhit's public face: for options, JSON, keys, panels and prices.
whit_module(settings
  SOURCES values.c
  LINK whit_api)
