mod damage;
mod golden;
mod late;
mod script;
mod writes;
