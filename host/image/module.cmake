whit_module(image
  SOURCES image.c compare.c display.c edges.c estimate.c exr.c flip.c hdr.c heat.c image_reply.c legend.c pfm.c png.c
          rows.c
  LINK whit_base PNG::PNG OpenEXR::OpenEXRCore PkgConfig::STB)
