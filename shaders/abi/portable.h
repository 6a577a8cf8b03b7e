/* Which function kernel/portable.comp computes: the values of its specialization constant 1. */
#ifndef ABI_PORTABLE_H
#define ABI_PORTABLE_H

#define PORTABLE_DIVIDE      0u
#define PORTABLE_SQRT        1u
#define PORTABLE_INVERSESQRT 2u
#define PORTABLE_EXP2        3u
#define PORTABLE_EXP         4u
#define PORTABLE_LOG2        5u
#define PORTABLE_LOG         6u
#define PORTABLE_POW         7u
#define PORTABLE_SIN         8u
#define PORTABLE_COS         9u
#define PORTABLE_TAN         10u
#define PORTABLE_ASIN        11u
#define PORTABLE_ACOS        12u
#define PORTABLE_ATAN        13u
#define PORTABLE_ATAN2       14u
#define PORTABLE_MIN         15u
#define PORTABLE_MAX         16u
#define PORTABLE_INT         17u
#define PORTABLE_UINT        18u
#define PORTABLE_RELATIONS   22u /* bits: less, at most, equal, unequal, more, at least, step */
#define PORTABLE_ABS         23u
/* host/render/portable.c runs these to find out whether a device gives portable kernels right
   results. SUM and PRODUCT are by the device's own arithmetic. */
#define PORTABLE_SUM      19u
#define PORTABLE_PRODUCT  20u
#define PORTABLE_COMPARED 21u /* see compare() of kernel/portable.comp */

#define COMPARED_ROOTS     (1u << 24)
#define COMPARED_INVERSES  (1u << 24)
#define COMPARED_QUOTIENTS 10000000u
#define COMPARED_ALL       (COMPARED_ROOTS + COMPARED_INVERSES + COMPARED_QUOTIENTS)

#endif
