#!/bin/sh
# Makes the matrices of the crank with CalculiX (apt-get install calculix-ccx), packed as they are kept here.
set -e
cd "$(dirname "$0")"
python3 make_deck.py
ccx crank > crank.log
gzip -9 -n -f crank.sti crank.mas
rm -f crank.log crank.12d crank.cvg crank.dat crank.frd crank.sta spooles.out
