"""Decision diagrams: manager and limits, order of bits, bit vectors, symbols of a contract."""
