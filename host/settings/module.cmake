# All settings, what their options are called, take and change: for options, JSON, recipes, keys,
# panels and prices. Over libwhit's public face.
whit_module(settings
  SOURCES values.c setting.c table.c builder.c effects.c camera.c settings.c quote.c
  LINK whit_api whit_base)
